from .ifs_morph_addon import register, unregister  # noqa: D104, F401 -- Blender calls both
