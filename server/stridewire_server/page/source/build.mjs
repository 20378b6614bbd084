// Bundles the page: `npm ci && npm run build` here, or `make page` at the top.
//
// Reads the contract from proto/, writes ../built. The hash of the sources here goes with the bundle,
// so that a test can tell whether it was made of them; not that of the contract, which only grows, so
// that a page made of an earlier one goes on working.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = path.dirname(fileURLToPath(import.meta.url));
const protos = path.join(here, "../../../../proto");
const built = path.join(here, "../built");
const PROTO_FILES = ["animation", "match", "pose"].map((name) => `stridewire/v1/${name}.proto`);

process.chdir(here);
rmSync("made", { recursive: true, force: true });
const plugins = [{ local: "./node_modules/.bin/protoc-gen-es", out: "made", opt: ["target=js"] }];
const template = JSON.stringify({ version: "v2", plugins });
const paths = PROTO_FILES.flatMap((name) => ["--path", path.join(protos, name)]);
execFileSync("node_modules/.bin/buf", ["generate", protos, "--template", template, ...paths], {
  stdio: "inherit",
});

rmSync(built, { recursive: true, force: true });
mkdirSync(built);
await build({
  entryPoints: ["main.js"],
  outfile: path.join(built, "page.js"),
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none",
});
for (const name of ["index.html", "page.css", "icon.svg"]) copyFileSync(name, path.join(built, name));
writeFileSync(path.join(built, "LICENSES.txt"), licences());
writeFileSync(path.join(built, "sources.sha256"), `${hash()}\n`);

function licences() {
  const three = readFileSync("node_modules/three/LICENSE", "utf8").trim();
  const { version, license } = JSON.parse(readFileSync("node_modules/@bufbuild/protobuf/package.json"));
  const varint = readFileSync("node_modules/@bufbuild/protobuf/dist/esm/wire/varint.js", "utf8");
  const notice = varint.split("\n").filter((line) => line.startsWith("//"));
  const google = notice.map((line) => line.slice(3)).join("\n").split("\n\n").slice(0, 4).join("\n\n");
  const own = readFileSync(path.join(here, "../../../../LICENSE"), "utf8").trim();
  return [
    "page.js holds, beside code of Stridewire (Apache-2.0), the following.",
    `three.js\n\n${three}`,
    `@bufbuild/protobuf ${version}, ${license}, https://github.com/bufbuild/protobuf-es\n\n` +
      `Copyright Buf Technologies, Inc.\n\n${google}\n\n${own}`,
  ].join(`\n\n${"-".repeat(80)}\n\n`) + "\n";
}

// The hash of the sources: name and content of each, in the order of their names.
function hash() {
  const sources = readdirSync(".").filter((name) => /\.(js|mjs|json|html|css|svg)$/.test(name));
  const digest = createHash("sha256");
  for (const name of sources.sort()) digest.update(`${name}\n`).update(readFileSync(name));
  return digest.digest("hex");
}
