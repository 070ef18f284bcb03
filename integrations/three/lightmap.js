// Interflect's lightmaps in three.js: `new GLTFLoader().register((parser) => new LightmapExtension(parser))`.
// A material's extension MOZ_lightmap {index, texCoord, intensity} becomes its lightMap. Texels that are too bright for
// 8 bits have a gain in another texture, extras.gain {index, stops}: irradiance = texel x 2^(stops x gain) x intensity.
import {
  ClampToEdgeWrapping,
  DataTexture,
  DataUtils,
  HalfFloatType,
  LinearFilter,
  LinearSRGBColorSpace,
  PMREMGenerator,
  RGBAFormat,
  SRGBColorSpace,
} from "three";

export class LightmapExtension {
  constructor(parser) {
    this.name = "MOZ_lightmap";
    this.parser = parser;
    this.bright = new Map(); // textures with gains, by their index and set of coordinates
  }

  extendMaterialParams(materialIndex, params) {
    const lightmap = this.parser.json.materials[materialIndex].extensions?.[this.name];
    if (!lightmap) return null;
    params.lightMapIntensity = lightmap.intensity ?? 1;
    const { index, texCoord = 1, extras } = lightmap;
    if (!extras?.gain)
      return this.parser.assignTexture(params, "lightMap", { index, texCoord }, SRGBColorSpace);
    const key = `${index}/${texCoord}`;
    if (!this.bright.has(key)) this.bright.set(key, this.load(index, texCoord, extras.gain));
    return this.bright.get(key).then((texture) => { params.lightMap = texture; });
  }

  async load(index, texCoord, { index: gainIndex, stops }) {
    const load = (i) => this.parser.getDependency("texture", i);
    const [texels, gains] = (await Promise.all([load(index), load(gainIndex)])).map(bytesOf);
    const bytes = Float32Array.from({ length: 256 }, (_, i) => i / 255);
    const linear = bytes.map(fromSRGB), factor = bytes.map((x) => 2 ** (stops * x));
    const largest = 65504, half = (x) => DataUtils.toHalfFloat(Math.min(x, largest));
    const dim = Uint16Array.from(linear, half), opaque = half(1); // most texels have no gain
    const data = new Uint16Array(texels.data.length);
    for (let i = 0; i < data.length; i += 4) {
      const gain = gains.data[i];
      for (let c = i; c < i + 3; ++c)
        data[c] = gain ? half(linear[texels.data[c]] * factor[gain]) : dim[texels.data[c]];
      data[i + 3] = opaque;
    }
    const texture = new DataTexture(data, texels.width, texels.height, RGBAFormat, HalfFloatType);
    texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
    texture.magFilter = texture.minFilter = LinearFilter;
    texture.colorSpace = LinearSRGBColorSpace;
    texture.channel = texCoord;
    texture.needsUpdate = true;
    return texture;
  }
}

/** Metals reflect the lit scene around a point; they have no diffuse part for a lightmap, and would be black. */
export function addReflections(renderer, scene, position) {
  const metals = new Set();
  scene.traverse(({ material }) => {
    for (const each of [material].flat()) if (each?.metalness > 0.5) metals.add(each);
  });
  if (!metals.size) return;
  const generator = new PMREMGenerator(renderer), near = 0.01, far = 1000; // [m]
  const surroundings = generator.fromScene(scene, 0, near, far, { position }).texture;
  for (const metal of metals) metal.envMap = surroundings;
  generator.dispose();
}

function fromSRGB(value) {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

/** Returns the pixels of a texture that has been loaded. */
function bytesOf({ image }) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [image.width, image.height];
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, image.width, image.height);
}
