// Interflect's lightmaps in three.js: `new GLTFLoader().register((parser) => new LightmapExtension(parser))`.
// A material's extension MOZ_lightmap {index, texCoord, intensity} becomes its lightMap.
import { SRGBColorSpace } from "three";

export class LightmapExtension {
  constructor(parser) {
    this.name = "MOZ_lightmap";
    this.parser = parser;
  }

  extendMaterialParams(materialIndex, params) {
    const lightmap = this.parser.json.materials[materialIndex].extensions?.[this.name];
    if (!lightmap) return null;
    params.lightMapIntensity = lightmap.intensity ?? 1;
    const texture = { index: lightmap.index, texCoord: lightmap.texCoord ?? 1 };
    return this.parser.assignTexture(params, "lightMap", texture, SRGBColorSpace);
  }
}
