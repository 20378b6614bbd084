// Prints the Khronos validator's report on a glTF file as one JSON object.
//
//   node validate_gltf.mjs FILE
import fs from "node:fs";
import validator from "gltf-validator";

const bytes = new Uint8Array(fs.readFileSync(process.argv[2]));
console.log(JSON.stringify(await validator.validateBytes(bytes, { maxIssues: 20 })));
