"""Linear fractal shape interpolation: the mathematics, free of Blender (Burch & Hart 1997)."""
