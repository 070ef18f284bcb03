// Interflect's lightmaps in glTF Transform, which otherwise drops extensions that it does not know:
// `new NodeIO().registerExtensions([LightmapExtension])`. A material's extension MOZ_lightmap {index, texCoord, intensity}
// becomes a Lightmap, with the gain of bright texels in extras.gain {index, stops}.
import { Extension, ExtensionProperty, PropertyType, TextureChannel, TextureInfo } from "@gltf-transform/core";

const NAME = "MOZ_lightmap";
const DEFAULT_SET = 1; // of texture coordinates, as in three.js
const RGB = TextureChannel.R | TextureChannel.G | TextureChannel.B;

/** Irradiance on a material: texture x 2^(gain texture x stops) x intensity. */
export class Lightmap extends ExtensionProperty {
  static EXTENSION_NAME = NAME;

  init() {
    this.extensionName = NAME;
    this.propertyType = "Lightmap";
    this.parentTypes = [PropertyType.MATERIAL];
  }

  getDefaults() {
    // glTF Transform finds the coordinates of a texture "x" by the name "xInfo".
    const textureInfo = new TextureInfo(this.graph, "textureInfo").setTexCoord(DEFAULT_SET);
    const gainTextureInfo = new TextureInfo(this.graph, "gainTextureInfo").setTexCoord(DEFAULT_SET);
    const textures = { texture: null, textureInfo, gainTexture: null, gainTextureInfo };
    return { ...super.getDefaults(), ...textures, intensity: 1, stops: 0 };
  }

  getIntensity() {
    return this.get("intensity");
  }
  setIntensity(intensity) {
    return this.set("intensity", intensity);
  }
  getTexture() {
    return this.getRef("texture");
  }
  setTexture(texture) {
    return this.setRef("texture", texture, { channels: RGB, isColor: true });
  }
  /** Null without a texture, as in other properties. */
  getTextureInfo() {
    return this.getTexture() ? this.getRef("textureInfo") : null;
  }
  getStops() {
    return this.get("stops");
  }
  setStops(stops) {
    return this.set("stops", stops);
  }
  getGainTexture() {
    return this.getRef("gainTexture");
  }
  setGainTexture(texture) {
    return this.setRef("gainTexture", texture, { channels: RGB });
  }
  getGainTextureInfo() {
    return this.getGainTexture() ? this.getRef("gainTextureInfo") : null;
  }
}

export class LightmapExtension extends Extension {
  static EXTENSION_NAME = NAME;
  extensionName = NAME;

  createLightmap() {
    return new Lightmap(this.document.getGraph());
  }

  read(context) {
    const { json } = context.jsonDoc;
    (json.materials ?? []).forEach((material, i) => {
      const source = material.extensions?.[NAME];
      if (!source) return;
      const { index, texCoord = DEFAULT_SET, intensity = 1, extras: { gain, ...extras } = {} } = source;
      const texture = (of) => context.textures[json.textures[of].source];
      const lightmap = this.createLightmap().setIntensity(intensity).setTexture(texture(index)).setExtras(extras);
      context.setTextureInfo(lightmap.getTextureInfo(), { index, texCoord });
      if (gain) {
        lightmap.setStops(gain.stops).setGainTexture(texture(gain.index));
        context.setTextureInfo(lightmap.getGainTextureInfo(), { index: gain.index, texCoord });
      }
      context.materials[i].setExtension(NAME, lightmap);
    });
    return this;
  }

  write(context) {
    for (const material of this.document.getRoot().listMaterials()) {
      const lightmap = material.getExtension(NAME);
      if (!lightmap?.getTexture()) continue;
      const info = context.createTextureInfoDef(lightmap.getTexture(), lightmap.getTextureInfo());
      const json = { texCoord: 0, ...info, intensity: lightmap.getIntensity(), extras: { ...lightmap.getExtras() } };
      const gain = lightmap.getGainTexture();
      if (gain) {
        const { index } = context.createTextureInfoDef(gain, lightmap.getGainTextureInfo());
        json.extras.gain = { index, stops: lightmap.getStops() };
      }
      if (!Object.keys(json.extras).length) delete json.extras;
      const target = context.jsonDoc.json.materials[context.materialIndexMap.get(material)];
      target.extensions = { ...target.extensions, [NAME]: json };
    }
    return this;
  }
}
