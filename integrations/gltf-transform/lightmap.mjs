// Interflect's lightmaps in glTF Transform, which otherwise drops extensions that it does not know:
// `new NodeIO().registerExtensions([LightmapExtension])`. A material's extension MOZ_lightmap {index, texCoord, intensity}
// becomes a Lightmap.
import { Extension, ExtensionProperty, PropertyType, TextureChannel, TextureInfo } from "@gltf-transform/core";

const NAME = "MOZ_lightmap";
const DEFAULT_SET = 1; // of texture coordinates, as in three.js

/** Irradiance on a material: texture x intensity. */
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
    return { ...super.getDefaults(), texture: null, textureInfo, intensity: 1 };
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
    const { R, G, B } = TextureChannel;
    return this.setRef("texture", texture, { channels: R | G | B, isColor: true });
  }
  /** Null without a texture, as in other properties. */
  getTextureInfo() {
    return this.getTexture() ? this.getRef("textureInfo") : null;
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
      const lightmap = this.createLightmap().setIntensity(source.intensity ?? 1);
      lightmap.setTexture(context.textures[json.textures[source.index].source]);
      context.setTextureInfo(lightmap.getTextureInfo(), { ...source, texCoord: source.texCoord ?? DEFAULT_SET });
      context.materials[i].setExtension(NAME, lightmap);
    });
    return this;
  }

  write(context) {
    for (const material of this.document.getRoot().listMaterials()) {
      const lightmap = material.getExtension(NAME);
      if (!lightmap?.getTexture()) continue;
      const info = context.createTextureInfoDef(lightmap.getTexture(), lightmap.getTextureInfo());
      const target = context.jsonDoc.json.materials[context.materialIndexMap.get(material)];
      target.extensions = {
        ...target.extensions,
        [NAME]: { texCoord: 0, ...info, intensity: lightmap.getIntensity() },
      };
    }
    return this;
  }
}
