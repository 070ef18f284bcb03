// Interflect's lightmaps in PlayCanvas: `new Asset("scene", "container", { url: "scene.glb" }, null, lightmapOptions())`.
// A material's extension MOZ_lightmap {index, texCoord, intensity} becomes its lightMap, and a chunk of its shader
// multiplies the texel by intensity / pi; the engine multiplies by the albedo. Texels that are too bright for 8 bits have a
// gain in another texture, extras.gain {index, stops}: irradiance = texel x 2^(stops x gain) x intensity.
import {
  ADDRESS_CLAMP_TO_EDGE,
  Color,
  Entity,
  EnvLighting,
  FILTER_LINEAR,
  FloatPacking,
  GAMMA_NONE,
  PIXELFORMAT_RGBA16F,
  RENDERTARGET_ORIGIN_TOP,
  RenderTarget,
  SHADERLANGUAGE_GLSL,
  SHADERLANGUAGE_WGSL,
  ShaderChunks,
  Texture,
  TONEMAP_NONE,
} from "playcanvas";

const EXTENSION = "MOZ_lightmap", INTENSITY = "material_lightMapIntensity";

/**
 * Returns the options of one container asset, which add lightmaps to the materials of its glTF file. The engine copies
 * materials of meshes without normals at once, so each gets its lightmap as soon as it is made.
 */
export function lightmapOptions() {
  const textures = new Map(), bright = new Map(); // by their glTF object; with gains, by the indices of both images
  let gltf;
  const textureOf = (index) => textures.get(gltf.textures[index]);

  function lightmapTexture({ index, extras }) {
    const texture = textureOf(index), gain = extras?.gain;
    if (!gain) {
      texture.srgb = true;
      return texture;
    }
    const key = `${index}/${gain.index}`;
    if (!bright.has(key)) bright.set(key, brightTexture(texture, textureOf(gain.index), gain.stops));
    return bright.get(key);
  }

  function addLightmap({ extensions }, material) {
    const lightmap = extensions?.[EXTENSION];
    if (!lightmap) return;
    material.lightMap = lightmapTexture(lightmap);
    material.lightMapChannel = "rgb";
    material.lightMapUv = lightmap.texCoord ?? 1;
    setLightmapIntensity(material, lightmap.intensity ?? 1);
    for (const [language, chunk] of Object.entries(CHUNKS)) material.getShaderChunks(language).set("lightmapAddPS", chunk);
    material.update();
  }

  return {
    global: { preprocess: (file) => { gltf = file; } },
    texture: { postprocess: (texture, asset) => textures.set(texture, asset.resource) },
    material: { postprocess: addLightmap },
  };
}

/** Sets the factor of a material's lightmap; it contains the exposure. */
export function setLightmapIntensity(material, intensity) {
  material.setParameter(INTENSITY, intensity);
}

function brightTexture(texture, gainTexture, stops) {
  const texels = pixels(texture), gains = pixels(gainTexture);
  const bytes = Float32Array.from({ length: 256 }, (_, i) => i / 255);
  const linear = bytes.map(fromSRGB), factor = bytes.map((x) => 2 ** (stops * x));
  const largest = 65504, half = (x) => FloatPacking.float2Half(Math.min(x, largest));
  const dim = Uint16Array.from(linear, half), opaque = half(1); // most texels have no gain
  const data = new Uint16Array(texels.data.length);
  for (let i = 0; i < data.length; i += 4) {
    const gain = gains.data[i];
    for (let c = i; c < i + 3; ++c)
      data[c] = gain ? half(linear[texels.data[c]] * factor[gain]) : dim[texels.data[c]];
    data[i + 3] = opaque;
  }
  return new Texture(texture.device, {
    name: texture.name, width: texels.width, height: texels.height, format: PIXELFORMAT_RGBA16F, mipmaps: false,
    minFilter: FILTER_LINEAR, magFilter: FILTER_LINEAR, addressU: ADDRESS_CLAMP_TO_EDGE, addressV: ADDRESS_CLAMP_TO_EDGE,
    levels: [data],
  });
}

/** Returns the bytes of a texture's image. */
function pixels(texture) {
  const image = texture.getSource(), canvas = new OffscreenCanvas(texture.width, texture.height);
  const drawing = canvas.getContext("2d", { willReadFrequently: true });
  drawing.drawImage(image, 0, 0);
  return drawing.getImageData(0, 0, canvas.width, canvas.height);
}

function fromSRGB(value) {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

// The parameters are those of the engine's own chunk. Gloss reduces the light like the engine's ambient light.
const CHUNKS = {
  [SHADERLANGUAGE_GLSL]: `
    uniform float ${INTENSITY};
    void addLightMap(vec3 lightmap, vec3 dir, vec3 worldNormal, vec3 viewDir, vec3 reflectionDir, float gloss, vec3 specularity,
                     vec3 vertexNormal, mat3 tbn
    #if defined(LIT_IRIDESCENCE)
                     , vec3 iridescenceFresnel, float iridescenceIntensity
    #endif
    ) {
      vec3 radiance = lightmap * (${INTENSITY} / ${Math.PI});
      #ifdef LIT_SPECULAR
        radiance *= 1.0 - specularity;
      #endif
      dDiffuseLight += radiance;
    }`,
  [SHADERLANGUAGE_WGSL]: `
    uniform ${INTENSITY}: f32;
    fn addLightMap(lightmap: vec3f, dir: vec3f, worldNormal: vec3f, viewDir: vec3f, reflectionDir: vec3f, gloss: f32,
                   specularity: vec3f, vertexNormal: vec3f, tbn: mat3x3f
    #if defined(LIT_IRIDESCENCE)
                   , iridescenceFresnel: vec3f, iridescenceIntensity: f32
    #endif
    ) {
      var radiance: vec3f = lightmap * (uniform.${INTENSITY} / ${Math.PI});
      #ifdef LIT_SPECULAR
        radiance *= vec3f(1.0) - specularity;
      #endif
      dDiffuseLight += radiance;
    }`,
};

/** Replaces the engine's approximation of sRGB by a power of 2.2, which shows dark colours too bright. Call it before you load. */
export function useExactSRGB({ graphicsDevice }) {
  for (const [language, type] of [[SHADERLANGUAGE_GLSL, "vec3"], [SHADERLANGUAGE_WGSL, "vec3f"]]) {
    const chunks = ShaderChunks.get(graphicsDevice, language), gamma = chunks.get("gammaPS");
    const approximation = `pow(color + 0.0000001, ${type}(1.0 / 2.2))`;
    if (!gamma.includes(approximation)) throw new Error("lightmap.mjs: this version of PlayCanvas has another gammaPS");
    const limit = `${type}(0.0031308)`, bright = `1.055 * pow(max(color, ${limit}), ${type}(1.0 / 2.4)) - 0.055`;
    chunks.set("gammaPS", gamma.replace(approximation, `mix(12.92 * color, ${bright}, step(${limit}, color))`));
  }
}

/** Metals reflect the lit scene around a point; they have no diffuse part for a lightmap, and would be black. */
export function addReflections(app, position) {
  const materials = app.root.findComponents("render").flatMap(({ meshInstances }) => meshInstances.map((m) => m.material));
  const metals = new Set(materials.filter(({ useMetalness, metalness }) => useMetalness && metalness > 0.5));
  if (!metals.size) return;
  const size = 256; // [pixels]
  const colorBuffer = new Texture(app.graphicsDevice, {
    name: "surroundings", cubemap: true, width: size, height: size, format: PIXELFORMAT_RGBA16F, mipmaps: true,
  });
  const angles = [[0, 90, 0], [0, -90, 0], [-90, 0, 180], [90, 0, 180], [0, 180, 0], [0, 0, 0]]; // of the faces [degrees]
  const enabled = app.root.findComponents("camera").filter((camera) => camera.enabled);
  for (const camera of enabled) camera.enabled = false;
  const cameras = angles.map((angle, face) => {
    const camera = new Entity();
    camera.addComponent("camera", {
      aspectRatio: 1, aspectRatioMode: 1, fov: 90, nearClip: 0.01, farClip: 1000, clearColor: Color.BLACK,
      gammaCorrection: GAMMA_NONE, toneMapping: TONEMAP_NONE,
      renderTarget: new RenderTarget({ colorBuffer, face, depth: true, origin: RENDERTARGET_ORIGIN_TOP }),
    });
    camera.setPosition(position);
    camera.setEulerAngles(...angle);
    app.root.addChild(camera);
    return camera;
  });
  app.render();
  for (const camera of cameras) {
    camera.camera.renderTarget.destroy();
    camera.destroy();
  }
  for (const camera of enabled) camera.enabled = true;
  const envAtlas = EnvLighting.generateAtlas(EnvLighting.generateLightingSource(colorBuffer));
  for (const metal of metals) {
    metal.envAtlas = envAtlas;
    metal.update();
  }
}
