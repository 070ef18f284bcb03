"""Blender add-on: computes the diffuse light of the scene with Interflect and shows it on the surfaces."""

import os
import shutil
import tempfile
import textwrap
from pathlib import Path

import bpy

from . import exchange, pipeline, result, world
from .lit.materials import glTF2ImportUserExtension  # the importer looks for it here

bl_info = {
    "name": "Interflect",
    "author": "The Interflect authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Interflect",
    "description": "Bakes diffuse global illumination, where the camera looks first",
    "category": "Render",
}

POLL = 0.2  # [s]
LETTER = 7  # approximate width of a letter in panels [pixels]


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
    target: bpy.props.EnumProperty(
        name="Target",
        items=[
            ("COPY", "Lit copy", "A collection replaces the objects, with each side of a face lit"),
            ("OBJECTS", "Objects themselves", "A UV map and images, in copies of the objects' own materials"),
        ],
    )
    use_selected: bpy.props.BoolProperty(
        name="Selected objects only",
        default=False,
        description="Show the light of the selected objects only; the others still give and reflect light",
    )
    texels_per_metre: bpy.props.FloatProperty(name="Texels per metre", default=16, min=0.1, max=1000)
    gather: bpy.props.BoolProperty(
        name="Final gathering", default=False, description="Cleaner lightmaps, which take much longer"
    )
    use_preview: bpy.props.BoolProperty(
        name="Preview", default=True, description="Show the light of a sixteenth of the rays first"
    )


class Bake(bpy.types.Operator):
    """Find the light of the scene and show its surfaces lit"""

    bl_idname = "interflect.bake"
    bl_label = "Bake Light"
    bl_options = {"UNDO"}

    running: pipeline.Bake | None = None  # at most one for all windows
    folder: Path | None = None  # its temporary files

    @classmethod
    def poll(cls, _context):
        if Bake.running:
            cls.poll_message_set("Interflect is baking already")
        return Bake.running is None

    def execute(self, context):
        """Without a user interface: waits for the end of the bake."""
        if not self._start(context):
            return {"CANCELLED"}
        while Bake.running.is_running():
            Bake.running.wait(POLL)
            self._show_preview()
        return self._finish()

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        if not self._start(context):
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(POLL, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            Bake.running.cancel()
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if Bake.running.is_running():
            percent = 100 * Bake.running.fraction
            context.window_manager.progress_update(percent)
            context.workspace.status_text_set(f"Interflect: {Bake.running.stage} {percent:.0f}%  (Esc: cancel)")
            _redraw_panels(context)
            self._show_preview()
            return {"RUNNING_MODAL"}
        context.window_manager.event_timer_remove(self._timer)
        _end_progress(context)
        return self._finish()

    def cancel(self, context):
        """Called by Blender when it closes or opens another file."""
        context.window_manager.event_timer_remove(self._timer)
        Bake.stop(context)

    @classmethod
    def stop(cls, context):
        cls.running.cancel()
        cls.running.wait()
        _end_progress(context)
        cls._end()

    def _start(self, context) -> bool:
        settings, scene = context.scene.interflect, context.scene
        self._scene = scene.name  # undo replaces the scene itself
        Bake.folder = Path(tempfile.mkdtemp(prefix="interflect-"))
        file, solution, self._lit = (self.folder / name for name in ("scene.glb", "light.h5", "lit.glb"))
        is_copied = settings.kind == "VERTEX" or settings.target == "COPY"
        selected = {each.name for each in context.view_layer.objects.selected} if settings.use_selected else None
        self._receivers, self._has_preview = exchange.Receivers(is_copied, selected), False
        try:
            self._exported = exchange.export_scene(scene, file, self._receivers)
            self._warnings = self._exported.warnings
            wanted = pipeline.Settings(
                command=context.preferences.addons[__name__].preferences.command,
                rays=round(settings.rays * 1e6),
                views=self._views(scene, file) if settings.use_camera else [],
                kind=settings.kind,
                texels_per_metre=settings.texels_per_metre,
                gather=settings.gather,
                is_copied=is_copied,
                has_preview=settings.use_preview,
            )
            before = self._world(scene, wanted)
        except Exception as error:
            self._end()
            if isinstance(error, RuntimeError):  # reported by the exporter
                self.report({"ERROR"}, str(error))
                return False
            raise
        Bake.running = pipeline.Bake([*before, *pipeline.stages(file, solution, self._lit, wanted)])
        return True

    def _views(self, scene, file):
        if scene.camera is None:
            return []
        if scene.camera.name in exchange.camera_names(file):
            return [scene.camera.name]
        self._warnings.append(f"The camera '{scene.camera.name}' is left out: the rays go to all surfaces alike")
        return []

    def _world(self, scene, wanted) -> list[pipeline.Stage]:
        """Adds the world's light to the settings. Returns the stages that run before."""
        radiance = world.plain_radiance(scene.world)
        if radiance is None:
            environment = self.folder / "world.exr"
            stages = [pipeline.Stage("Rendering the world", world.rendering(scene, self.folder, environment))]
        else:
            if min(radiance) < 0:
                self._warnings.append("The world's colour is negative: it is baked as 0")
            if max(radiance) <= 0:
                return []
            environment, stages = self.folder / "world.hdr", []
            world.write_plain(environment, radiance)
        wanted.options += ["--environment", str(environment), "--zenith", "0,1,0"]
        return stages

    def _show_preview(self):
        file, Bake.running.preview = Bake.running.preview, None
        scene = bpy.data.scenes.get(self._scene)
        if not (file and scene):
            return
        try:
            exchange.show_light(scene, file, self._exported, self._receivers)
            self._has_preview = True
        except Exception as error:  # an exception would end the operator, but not the bake
            Bake.running.fail(str(error))

    def _finish(self):
        done = Bake.running
        scene = bpy.data.scenes.get(self._scene)
        in_folder = str(self.folder) + os.sep
        of_command = [pipeline.for_blender(each, in_folder) for each in done.warnings]
        try:
            if done.error:
                self.report({"ERROR"}, pipeline.for_blender(str(done.error), in_folder).removeprefix("error: "))
                return self._unfinished()
            if done.is_cancelled:
                self.report({"INFO"}, "Interflect: cancelled")
                return self._unfinished()
            if scene is None:
                self.report({"ERROR"}, f"The scene '{self._scene}' is there no longer: its light is lost")
                return {"CANCELLED"}
            of_scene = exchange.show_light(scene, self._lit, self._exported, self._receivers)
            warnings = list(dict.fromkeys(self._warnings + of_command + of_scene))
            result.set_warnings(scene, warnings)
            for warning in warnings:
                self.report({"WARNING"}, warning)
            return {"FINISHED"}
        except RuntimeError as error:  # reported by the importer
            self.report({"ERROR"}, str(error))
            return self._unfinished()
        finally:
            self._end()

    def _unfinished(self):
        return {"FINISHED"} if self._has_preview else {"CANCELLED"}  # a preview stays, as a step to undo

    @classmethod
    def _end(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)
        Bake.running = Bake.folder = None


class Cancel(bpy.types.Operator):
    """End the bake that is running, and leave the scene as it is"""

    bl_idname = "interflect.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, _context):
        return Bake.running is not None

    def execute(self, _context):
        Bake.running.cancel()
        return {"FINISHED"}


class Clear(bpy.types.Operator):
    """Remove the light and show the scene as it was"""

    bl_idname = "interflect.clear"
    bl_label = "Clear"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, _context):
        return Bake.running is None

    def execute(self, context):
        result.remove(context.scene)
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
            layout.prop(settings, "target")
            layout.prop(settings, "texels_per_metre")
            layout.prop(settings, "gather")
        layout.prop(settings, "use_selected")
        layout.prop(settings, "use_preview")
        row = layout.row()
        if Bake.running:
            row.label(text=f"{Bake.running.stage} {100 * Bake.running.fraction:.0f}%")
            row.operator(Cancel.bl_idname)
        else:
            row.operator(Bake.bl_idname)
            row.operator(Clear.bl_idname)
        letters = max(20, int(context.region.width / (LETTER * context.preferences.system.ui_scale)))
        for warning in result.warnings(context.scene):
            column = layout.column(align=True)
            for i, line in enumerate(textwrap.wrap(warning, letters)):
                column.label(text=line, icon="BLANK1" if i else "ERROR")


def _end_progress(context):
    context.window_manager.progress_end()
    context.workspace.status_text_set(None)
    _redraw_panels(context)


def _redraw_panels(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()


CLASSES = (Preferences, BakeSettings, Bake, Cancel, Clear, Panel)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.interflect = bpy.props.PointerProperty(type=BakeSettings)


def unregister():
    if Bake.running:
        Bake.stop(bpy.context)
    del bpy.types.Scene.interflect
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
