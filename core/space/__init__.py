"""Shapes in space: maps of three dimensions, decided by balls where those of the plane are decided by discs.

`SpaceIFS` and `SpaceMorph` stand where an `IFS` and a `Morph` do: `connectedness`, `compute_locus`, `plan_path`,
`match` and `point_cloud` take both kinds. Pictures are for shapes of the plane.
"""
