// Interflect's lightmaps in Babylon.js:
// `registerGLTFExtension("MOZ_lightmap", true, (loader) => new LightmapExtension(loader))`.
// A material's extension MOZ_lightmap {index, texCoord, intensity} becomes its lightmapTexture, and a plugin multiplies
// it by albedo / pi; Babylon.js itself adds it as radiance. Texels that are too bright for 8 bits have a gain in another
// texture, extras.gain {index, stops}: irradiance = texel x 2^(stops x gain) x intensity.
import { Constants } from "@babylonjs/core/Engines/constants.js";
import { MaterialPluginBase } from "@babylonjs/core/Materials/materialPluginBase.js";
import { RawTexture } from "@babylonjs/core/Materials/Textures/rawTexture.js";
import { RenderTargetTexture } from "@babylonjs/core/Materials/Textures/renderTargetTexture.js";
import { Texture } from "@babylonjs/core/Materials/Textures/texture.js";
import { ToHalfFloat } from "@babylonjs/core/Misc/textureTools.js";
import { RegisterClass } from "@babylonjs/core/Misc/typeStore.js";
import { ReflectionProbe } from "@babylonjs/core/Probes/reflectionProbe.js";
import { GLTFLoader } from "@babylonjs/loaders/glTF/2.0/glTFLoader.js";

export class LightmapExtension {
  constructor(loader) {
    this.name = "MOZ_lightmap";
    this.order = 1000; // after the extensions of materials that add layers
    this.loader = loader;
    this.enabled = loader.isExtensionUsed(this.name);
    this.bright = new Map(); // textures with gains, by the indices of both images
  }

  dispose() {
    this.loader = null;
    this.bright.clear();
  }

  loadMaterialPropertiesAsync(context, material, babylonMaterial) {
    return GLTFLoader.LoadExtensionAsync(context, material, this.name, async (place, lightmap) => {
      const [, texture] = await Promise.all([
        this.loader.loadMaterialPropertiesAsync(context, material, babylonMaterial),
        this.load(place, lightmap),
      ]);
      if (!("lightmapTexture" in babylonMaterial)) throw new Error(`${place}: the material is not a PBRMaterial`);
      texture.level = lightmap.intensity ?? 1;
      babylonMaterial.lightmapTexture = texture;
      babylonMaterial.useLightmapAsShadowmap = false;
      babylonMaterial.brdf.useLegacySpecularEnergyConservation = false; // gloss reduces diffuse light as in three.js
      new LightmapPlugin(babylonMaterial);
    });
  }

  async load(place, { index, texCoord = 1, extras }) {
    if (!extras?.gain) return this.loader.loadTextureInfoAsync(place, { index, texCoord });
    const key = `${index}/${extras.gain.index}`;
    if (!this.bright.has(key)) this.bright.set(key, this.loadBright(index, extras.gain));
    const texture = (await this.bright.get(key)).clone(); // intensity and coordinates belong to the material
    texture.coordinatesIndex = texCoord;
    texture.wrapU = texture.wrapV = Texture.CLAMP_ADDRESSMODE;
    texture.gammaSpace = false;
    return texture;
  }

  async loadBright(index, { index: gainIndex, stops }) {
    const [texels, gains] = await Promise.all([this.pixels(index), this.pixels(gainIndex)]);
    const bytes = Float32Array.from({ length: 256 }, (_, i) => i / 255);
    const linear = bytes.map(fromSRGB), factor = bytes.map((x) => 2 ** (stops * x));
    const largest = 65504, half = (x) => ToHalfFloat(Math.min(x, largest));
    const dim = Uint16Array.from(linear, half), opaque = half(1); // most texels have no gain
    const data = new Uint16Array(texels.data.length);
    for (let i = 0; i < data.length; i += 4) {
      const gain = gains.data[i];
      for (let c = i; c < i + 3; ++c)
        data[c] = gain ? half(linear[texels.data[c]] * factor[gain]) : dim[texels.data[c]];
      data[i + 3] = opaque;
    }
    return new RawTexture(
      data, texels.width, texels.height, Constants.TEXTUREFORMAT_RGBA, this.loader.babylonScene, false, false,
      Texture.BILINEAR_SAMPLINGMODE, Constants.TEXTURETYPE_HALF_FLOAT,
    );
  }

  /** Returns the bytes of a texture's image. */
  async pixels(index) {
    const { textures, images } = this.loader.gltf, { source, extensions } = textures[index];
    const image = images[Object.values(extensions ?? {}).find((extension) => extension.source >= 0)?.source ?? source];
    const file = new Blob([await this.loader.loadImageAsync(`/images/${image.index}`, image)]);
    const bitmap = await createImageBitmap(file, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const drawing = canvas.getContext("2d", { willReadFrequently: true });
    drawing.drawImage(bitmap, 0, 0);
    return drawing.getImageData(0, 0, bitmap.width, bitmap.height);
  }
}

/** Multiplies the lightmap by the diffuse reflectance / pi, reduced by the layers above it as for light of the environment. */
class LightmapPlugin extends MaterialPluginBase {
  constructor(material) {
    super(material, "InterflectLightmap", 200, undefined, true, true);
  }

  getClassName() {
    return "InterflectLightmapPlugin";
  }

  getCustomCode(shaderType) {
    if (shaderType !== "fragment") return null;
    return {
      CUSTOM_FRAGMENT_BEFORE_FINALCOLORCOMPOSITION: `
        #if defined(LIGHTMAP) && !defined(UNLIT)
          lightmapColor.rgb *= surfaceAlbedo.rgb / PI * aoOut.ambientOcclusionColor;
          #ifndef LEGACY_SPECULAR_ENERGY_CONSERVATION
            #if defined(METALLICWORKFLOW) || defined(SPECULAR_GLOSSINESS_ENERGY_CONSERVATION)
              vec3 lightmapSpecular = baseSpecularEnvironmentReflectance;
              #if defined(ENVIRONMENTBRDF) && defined(MS_BRDF_ENERGY_CONSERVATION)
                lightmapSpecular *= baseSpecularEnergyConservationFactor;
              #endif
              lightmapColor.rgb *= clamp(1. - lightmapSpecular, 0., 1.);
            #endif
            #ifdef SS_REFRACTION
              lightmapColor.rgb *= subSurfaceOut.refractionOpacity;
            #endif
          #endif
          #ifdef SS_TRANSLUCENCY
            lightmapColor.rgb *= 1. - subSurfaceOut.translucencyIntensity;
          #endif
          #ifdef CLEARCOAT
            lightmapColor.rgb *= clearcoatOut.conservationFactor;
          #endif
          #if defined(REFLECTION) && !defined(SS_TRANSLUCENCY)
            finalIrradiance = vec3(0.); // diffuse light of the environment is in the lightmap
          #endif
        #endif`,
    };
  }
}
RegisterClass("BABYLON.InterflectLightmapPlugin", LightmapPlugin);

/** Metals reflect the lit scene around a point; they have no diffuse part for a lightmap, and would be black. */
export async function addReflections(scene, position) {
  const metals = scene.materials.filter((material) => material.metallic > 0.5);
  if (!metals.length) return;
  await scene.whenReadyAsync();
  const size = 256; // [pixels]
  const probe = new ReflectionProbe("surroundings", size, scene, true, true, true);
  probe.position = position;
  probe.renderList = scene.meshes;
  probe.refreshRate = RenderTargetTexture.REFRESHRATE_RENDER_ONCE;
  scene.customRenderTargets.push(probe.cubeTexture);
  scene.render(); // renders the probe; no metal may reflect it yet
  scene.customRenderTargets.splice(scene.customRenderTargets.indexOf(probe.cubeTexture), 1);
  for (const metal of metals) {
    metal.reflectionTexture = probe.cubeTexture;
    metal.realTimeFiltering = true; // blurs by roughness
  }
}

function fromSRGB(value) {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}
