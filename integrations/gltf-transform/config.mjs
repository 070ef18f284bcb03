// For the command of glTF Transform: `gltf-transform optimize scene.glb small.glb --config config.mjs`.
import { ALL_EXTENSIONS } from "@gltf-transform/extensions";
import { LightmapExtension } from "./lightmap.mjs";

export default { extensions: [...ALL_EXTENSIONS, LightmapExtension] };
