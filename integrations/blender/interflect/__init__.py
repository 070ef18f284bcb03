"""Blender add-on: finds the diffuse light of the scene with Interflect and puts it onto its surfaces."""

import shutil
import tempfile
from pathlib import Path

import bpy

from . import exchange, pipeline
from .lit_materials import glTF2ImportUserExtension  # found here by the importer

bl_info = {
    "name": "Interflect",
    "author": "The Interflect authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Interflect",
    "description": "Bakes diffuse global illumination, where the camera looks first",
    "category": "Render",
}

POLL = 0.2  # [s]


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    command: bpy.props.StringProperty(name="Command", subtype="FILE_PATH", default="interflect")

    def draw(self, _context):
        self.layout.prop(self, "command")


class BakeSettings(bpy.types.PropertyGroup):
    rays: bpy.props.FloatProperty(
        name="Rays (millions)", default=20, min=0.01, max=100_000, description="More rays, less noise and finer elements"
    )
    use_camera: bpy.props.BoolProperty(
        name="For the camera",
        default=True,
        description="Spend the rays on what the scene's camera sees; else on all surfaces alike",
    )
    kind: bpy.props.EnumProperty(
        name="Result",
        items=[
            ("LIGHTMAP", "Lightmap", "An image, independent of the mesh"),
            ("VERTEX", "Vertex colours", "A mesh as fine as the light on it"),
        ],
    )
    texels_per_metre: bpy.props.FloatProperty(name="Texels per metre", default=16, min=0.1, max=1000)
    gather: bpy.props.BoolProperty(
        name="Final gathering", default=False, description="Cleaner lightmaps, which take much longer"
    )


class Bake(bpy.types.Operator):
    """Find the light of the scene and show its surfaces lit"""

    bl_idname = "interflect.bake"
    bl_label = "Bake Light"

    def execute(self, context):
        """Without a user interface: waits until it is done."""
        self._start(context)
        self._bake.wait()
        return self._finish(context)

    def invoke(self, context, _event):
        self._start(context)
        self._timer = context.window_manager.event_timer_add(POLL, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._bake.cancel()
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self._bake.is_running():
            percent = 100 * self._bake.fraction
            context.window_manager.progress_update(percent)
            context.workspace.status_text_set(f"Interflect: {self._bake.stage} {percent:.0f}%  (Esc: cancel)")
            return {"RUNNING_MODAL"}
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        return self._finish(context)

    def _start(self, context):
        settings = context.scene.interflect
        self._folder = Path(tempfile.mkdtemp(prefix="interflect-"))
        scene, solution, self._lit = (self._folder / name for name in ("scene.glb", "light.h5", "lit.glb"))
        exchange.export_scene(scene)
        wanted = pipeline.Settings(
            rays=round(settings.rays * 1e6),
            views=[context.scene.camera.name] if settings.use_camera and context.scene.camera else [],
            kind=settings.kind,
            texels_per_metre=settings.texels_per_metre,
            gather=settings.gather,
        )
        radiance = exchange.world_radiance()
        if radiance is None:
            self.report({"WARNING"}, "The world's light varies and is left out: only a plain background is baked")
        elif max(radiance) > 0:
            environment = self._folder / "world.hdr"
            exchange.write_environment(environment, radiance)
            wanted.options += ["--environment", str(environment), "--zenith", "0,1,0"]
        command = context.preferences.addons[__name__].preferences.command
        self._bake = pipeline.Bake(command, pipeline.stages(scene, solution, self._lit, wanted))

    def _finish(self, context):
        try:
            if self._bake.error:
                self.report({"ERROR"}, str(self._bake.error))
                return {"CANCELLED"}
            if self._bake.is_cancelled:
                return {"CANCELLED"}
            exchange.import_lit(self._lit)
            return {"FINISHED"}
        finally:
            shutil.rmtree(self._folder, ignore_errors=True)


class Clear(bpy.types.Operator):
    """Remove the lit surfaces and show the scene as it was"""

    bl_idname = "interflect.clear"
    bl_label = "Clear"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, _context):
        exchange.remove_lit()
        return {"FINISHED"}


class Panel(bpy.types.Panel):
    bl_idname = "RENDER_PT_interflect"
    bl_label = "Interflect"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings, layout = context.scene.interflect, self.layout
        layout.use_property_split = True
        layout.prop(settings, "rays")
        layout.prop(settings, "use_camera")
        layout.prop(settings, "kind")
        if settings.kind == "LIGHTMAP":
            layout.prop(settings, "texels_per_metre")
            layout.prop(settings, "gather")
        row = layout.row()
        row.operator(Bake.bl_idname)
        row.operator(Clear.bl_idname)


CLASSES = (Preferences, BakeSettings, Bake, Clear, Panel)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.interflect = bpy.props.PointerProperty(type=BakeSettings)


def unregister():
    del bpy.types.Scene.interflect
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
