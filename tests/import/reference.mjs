// Runs TensorFlow.js graph models on given inputs: node reference.mjs JOBS.json, in a folder with node_modules.
//
// JOBS.json: [{model, inputs: {name: {file, dims, dtype}}, outputs, out, backend}]. Files hold raw little-endian float32. For each job
// OUT.json lists the outputs [{name, dims}] and OUT.bin holds them one after the other as float32.
import { createRequire } from "node:module";
import fs from "node:fs";
import path from "node:path";

const require = createRequire(path.join(process.cwd(), "package.json"));
const tf = require("@tensorflow/tfjs");
const wasm = require("@tensorflow/tfjs-backend-wasm");
wasm.setWasmPaths(path.join(process.cwd(), "node_modules/@tensorflow/tfjs-backend-wasm/dist/"));

function handler(file) {
  const json = JSON.parse(fs.readFileSync(file, "utf8"));
  const paths = json.weightsManifest.flatMap((group) => group.paths);
  const shards = paths.map((name) => fs.readFileSync(path.join(path.dirname(file), name)));
  const bytes = Buffer.concat(shards);
  return {
    load: async () => ({
      ...json,
      weightSpecs: json.weightsManifest.flatMap((group) => group.weights),
      weightData: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length),
    }),
  };
}

async function run(job) {
  const model = await tf.loadGraphModel(handler(job.model));
  const inputs = {};
  for (const [name, { file, dims, dtype }] of Object.entries(job.inputs)) {
    const bytes = fs.readFileSync(file);
    const values = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
    inputs[name] = tf.tensor(dtype === "int32" ? Int32Array.from(values) : values, dims, dtype);
  }
  const results = [await model.executeAsync(inputs, job.outputs)].flat();
  const listed = results.map((tensor, index) => ({ name: job.outputs[index], dims: tensor.shape }));
  const data = await Promise.all(results.map((tensor) => tensor.data()));
  fs.writeFileSync(`${job.out}.json`, JSON.stringify(listed));
  fs.writeFileSync(`${job.out}.bin`, Buffer.concat(data.map((values) => Buffer.from(Float32Array.from(values).buffer))));
  model.dispose();
}

for (const job of JSON.parse(fs.readFileSync(process.argv[2], "utf8"))) {
  await tf.setBackend(job.backend);
  await run(job);
}
