// Optimizes a glTF file like the command of glTF Transform, which needs a newer Node.js than Debian's:
// node optimize.mjs INPUT OUTPUT [CONFIG.mjs].
import { resolve } from "node:path";
import { NodeIO } from "@gltf-transform/core";
import { ALL_EXTENSIONS } from "@gltf-transform/extensions";
import {
  dedup, flatten, instance, join, meshopt, palette, prune, resample, simplify, sparse, weld,
} from "@gltf-transform/functions";
import { MeshoptDecoder, MeshoptEncoder, MeshoptSimplifier } from "meshoptimizer";

const [input, output, config] = process.argv.slice(2);
const { extensions } = config ? (await import(resolve(config))).default : { extensions: ALL_EXTENSIONS };
await Promise.all([MeshoptDecoder.ready, MeshoptEncoder.ready, MeshoptSimplifier.ready]);
const io = new NodeIO()
  .registerExtensions(extensions)
  .registerDependencies({ "meshopt.decoder": MeshoptDecoder, "meshopt.encoder": MeshoptEncoder });
const scene = await io.read(input);
await scene.transform(
  dedup(), instance(), palette(), flatten(), join(), weld(), simplify({ simplifier: MeshoptSimplifier }), resample(),
  prune(), sparse(), meshopt({ encoder: MeshoptEncoder }),
);
await io.write(output, scene);
