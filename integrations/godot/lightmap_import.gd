# Interflect's lightmaps in Godot 3: Import > Custom Script of a .glb file.
# A material's extension MOZ_lightmap {index, texCoord, intensity} becomes an unshaded ShaderMaterial: albedo / pi x texel
# x intensity + emission. Texels that are too bright for 8 bits have a gain in another texture, extras.gain {index, stops}:
# irradiance = texel x 2^(stops x gain) x intensity. Metals keep their material, because they have no diffuse part.
tool
extends EditorScenePostImport

const EXTENSION = "MOZ_lightmap"
const CHUNK_JSON = 0x4E4F534A
const SHADER = """
shader_type spatial;
render_mode unshaded%s;
uniform vec4 albedo : hint_color;
uniform sampler2D albedo_texture : hint_albedo;
uniform sampler2D lightmap : hint_albedo;
uniform sampler2D gain : hint_black;
uniform float stops = 0.0;
uniform vec2 size = vec2(1.0);  // of both [texels]
uniform float intensity = 1.0;
uniform vec3 emission = vec3(0.0);
uniform sampler2D emission_texture : hint_albedo;

vec3 texel(vec2 at) {
	vec2 centre = (at + 0.5) / size;
	return texture(lightmap, centre).rgb * exp2(stops * texture(gain, centre).r);
}

// The product of texel and gain is interpolated, not its factors.
vec3 irradiance(vec2 uv) {
	if (stops == 0.0) return texture(lightmap, uv).rgb;
	vec2 last = size - 1.0;
	vec2 at = clamp(uv * size - 0.5, vec2(0.0), last);
	vec2 low = floor(at);
	vec2 high = min(low + 1.0, last);
	vec2 share = at - low;
	return mix(mix(texel(low), texel(vec2(high.x, low.y)), share.x),
	           mix(texel(vec2(low.x, high.y)), texel(high), share.x), share.y);
}

void fragment() {
	vec4 reflectance = albedo * texture(albedo_texture, UV);
	vec3 emitted = emission * texture(emission_texture, UV).rgb;
	ALBEDO = reflectance.rgb * irradiance(UV2) * intensity / 3.14159265 + emitted;
	%s
}
"""

var gltf: Dictionary
var binary: PoolByteArray
var images = {}  # textures by the index of their glTF texture and their flags
var materials = {}  # by the index of their glTF material
var shaders = {}  # by their code


func post_import(scene):
	if not read_file(get_source_file()):
		push_error("%s is not a .glb file: without lightmaps" % get_source_file())
		return scene
	var instances = []
	collect_instances(scene, instances)
	var nodes = []
	for root in gltf.scenes[gltf.get("scene", 0)].nodes:
		collect_nodes(root, nodes)
	if instances.size() != nodes.size():
		push_error("%s: %d meshes in the file, %d in the scene" % [get_source_file(), nodes.size(), instances.size()])
		return scene
	for i in instances.size():
		add_lightmaps(instances[i], gltf.meshes[gltf.nodes[nodes[i]].mesh].primitives)
	return scene


# The importer keeps the order of nodes, primitives and vertices.
func collect_instances(node, instances):
	if node is MeshInstance:
		instances.append(node)
	for child in node.get_children():
		collect_instances(child, instances)


func collect_nodes(index, nodes):
	var node = gltf.nodes[index]
	if node.has("mesh"):
		nodes.append(index)
	for child in node.get("children", []):
		collect_nodes(child, nodes)


# The importer stores texture coordinates as 16-bit floats, which shift a large lightmap by half a texel: the mesh gets the
# coordinates of the file.
func add_lightmaps(instance, primitives):
	var old = instance.mesh
	var mesh = ArrayMesh.new()
	mesh.resource_name = old.resource_name
	for i in old.get_surface_count():
		var primitive = primitives[i]
		var material = old.surface_get_material(i)
		var arrays = old.surface_get_arrays(i)
		var lightmap = lightmap_of(primitive)
		if lightmap and material is SpatialMaterial and material.metallic <= 0.5:
			var set = "TEXCOORD_%d" % lightmap.get("texCoord", 1)
			arrays[Mesh.ARRAY_TEX_UV2] = coordinates(primitive.attributes[set], arrays[Mesh.ARRAY_VERTEX].size(), primitive)
			material = lit_material(int(primitive.material), material, lightmap)
		var flags = Mesh.ARRAY_COMPRESS_DEFAULT & ~Mesh.ARRAY_COMPRESS_TEX_UV2
		mesh.add_surface_from_arrays(old.surface_get_primitive_type(i), arrays, old.surface_get_blend_shape_arrays(i), flags)
		mesh.surface_set_material(i, material)
		mesh.surface_set_name(i, old.surface_get_name(i))
	instance.mesh = mesh


func lightmap_of(primitive):
	if not primitive.has("material"):
		return null
	return gltf.materials[primitive.material].get("extensions", {}).get(EXTENSION)


func lit_material(index, author, lightmap):
	if materials.has(index):
		return materials[index]
	var description = gltf.materials[index]
	var material = ShaderMaterial.new()
	material.resource_name = author.resource_name
	material.shader = shader(description)
	material.set_shader_param("albedo", author.albedo_color)
	material.set_shader_param("albedo_texture", author.albedo_texture)
	material.set_shader_param("lightmap", image(lightmap.index, Texture.FLAG_FILTER))
	material.set_shader_param("intensity", lightmap.get("intensity", 1.0))
	var gain = lightmap.get("extras", {}).get("gain")
	if gain:
		material.set_shader_param("gain", image(gain.index, 0))
		material.set_shader_param("stops", gain.stops)
		material.set_shader_param("size", material.get_shader_param("lightmap").get_size())
	var factor = description.get("emissiveFactor", [0, 0, 0])
	var strength = description.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
	material.set_shader_param("emission", Vector3(factor[0], factor[1], factor[2]) * strength)
	material.set_shader_param("emission_texture", author.emission_texture)
	materials[index] = material
	return material


func shader(description):
	var alpha = ""
	if description.get("alphaMode", "OPAQUE") != "OPAQUE":
		alpha = "ALPHA = reflectance.a;"
	if description.get("alphaMode", "OPAQUE") == "MASK":
		alpha += "\n\tALPHA_SCISSOR = %f;" % description.get("alphaCutoff", 0.5)
	var code = SHADER % [", cull_disabled" if description.get("doubleSided", false) else "", alpha]
	if not shaders.has(code):
		shaders[code] = Shader.new()
		shaders[code].code = code
	return shaders[code]


# Images of .glb files are embedded.
func image(index, flags):
	var key = [index, flags]
	if not images.has(key):
		var source = gltf.images[gltf.textures[index].source]
		var loaded = Image.new()
		loaded.load_png_from_buffer(view(source.bufferView))
		images[key] = ImageTexture.new()
		images[key].create_from_image(loaded, flags)
		images[key].resource_name = source.get("name", "")
	return images[key]


# Returns texture coordinates for the vertices of a surface, which may be those of the file or one for each index.
func coordinates(accessor_index, vertex_count, primitive):
	var values = numbers(gltf.accessors[accessor_index], 2)
	var result = PoolVector2Array()
	result.resize(vertex_count)
	if values.size() == 2 * vertex_count:
		for i in vertex_count:
			result[i] = Vector2(values[2 * i], values[2 * i + 1])
		return result
	var indices = numbers(gltf.accessors[primitive.indices], 1)
	for i in vertex_count:
		result[i] = Vector2(values[2 * indices[i]], values[2 * indices[i] + 1])
	return result


func numbers(accessor, width):
	var bytes = StreamPeerBuffer.new()
	bytes.data_array = binary
	var description = gltf.bufferViews[accessor.bufferView]
	var size = {5121: 1, 5123: 2, 5125: 4, 5126: 4}[int(accessor.componentType)]
	var start = int(description.get("byteOffset", 0)) + int(accessor.get("byteOffset", 0))
	var stride = int(description.get("byteStride", width * size))
	var result = []
	for i in accessor.count:
		for k in width:
			bytes.seek(start + i * stride + k * size)
			result.append(number(bytes, int(accessor.componentType), accessor.get("normalized", false)))
	return result


func number(bytes, type, normalized):
	match type:
		5121:
			return bytes.get_u8() / (255.0 if normalized else 1.0)
		5123:
			return bytes.get_u16() / (65535.0 if normalized else 1.0)
		5125:
			return bytes.get_u32()
	return bytes.get_float()


func view(index):
	var description = gltf.bufferViews[index]
	var start = int(description.get("byteOffset", 0))
	return binary.subarray(start, start + int(description.byteLength) - 1)


func read_file(path):
	var file = File.new()
	if file.open(path, File.READ) != OK or file.get_buffer(4).get_string_from_ascii() != "glTF":
		return false
	file.seek(12)
	while file.get_position() < file.get_len():
		var length = file.get_32()
		var type = file.get_32()
		var chunk = file.get_buffer(length)
		if type == CHUNK_JSON:
			gltf = JSON.parse(chunk.get_string_from_utf8()).result
		elif binary.size() == 0:
			binary = chunk
	return true
