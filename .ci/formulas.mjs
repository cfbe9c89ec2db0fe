// Typesets formulas: reads a list of { tex, display } in JSON, writes the list of their HTML. A formula that is wrong ends it.
//
//     node formulas.mjs FOLDER_WITH_NODE_MODULES < formulas.json > html.json
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { readFileSync } from "node:fs";

const katex = createRequire(resolve(process.argv[2], "package.json"))("katex");
const formulas = JSON.parse(readFileSync(0, "utf8"));
const html = formulas.map(({ tex, display }) => katex.renderToString(tex, { displayMode: display, strict: "error" }));
process.stdout.write(JSON.stringify(html));
