"""What the panels in the sidebar of the viewport have in common."""


class SidebarPanel:
    """A panel of the tab *IFS Morph*, for morph objects."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "IFS Morph"

    @classmethod
    def poll(cls, context):
        """Sub-panels show for morph objects only."""
        return context.object is not None and context.object.ifs_morph.kind != "NONE"
