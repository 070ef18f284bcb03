# Run by Godot 3: godot3 --path PROJECT -s draw_in_godot.gd FILE.glb:CAMERA... Draws imported files of the project.
# Writes FILE.glb.CAMERA.godot.png and prints lines of JSON: the smallest and the largest value of each picture's pixels.
extends SceneTree


func _init():
	call_deferred("draw")


func draw():
	for argument in OS.get_cmdline_args():
		if ":" in argument:
			var names = argument.split(":")
			yield(draw_file(names[0], names[1]), "completed")
	quit()


func draw_file(file, camera_name):
	var scene = load("res://" + file).instance()
	get_root().add_child(scene)
	find_camera(scene, camera_name).current = true
	for frame in 3:  # the first frames may lack shaders
		yield(self, "idle_frame")
	var image = get_root().get_texture().get_data()
	image.flip_y()
	image.save_png("res://%s.%s.godot.png" % [file, camera_name])
	image.convert(Image.FORMAT_RGB8)
	var bytes = Array(image.get_data())
	print("DRAWN ", to_json([bytes.min(), bytes.max()]))
	scene.free()


func find_camera(node, name):
	if node is Camera and node.name.begins_with(name):
		return node
	for child in node.get_children():
		var found = find_camera(child, name)
		if found:
			return found
	return null
