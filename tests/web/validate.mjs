// Prints the Khronos validator's reports on glTF files as JSON: {FILE: report}.
import { readFileSync } from "node:fs";
import validator from "gltf-validator";

const reports = {};
for (const file of process.argv.slice(2))
  reports[file] = await validator.validateBytes(new Uint8Array(readFileSync(file)));
console.log(JSON.stringify(reports));
