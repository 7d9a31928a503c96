// Makes the PNG of icon.svg that the marketplace requires: `npm run icon`.

import { readFile, writeFile } from "node:fs/promises";
import { Resvg } from "@resvg/resvg-js";

const svg = await readFile(new URL("icon.svg", import.meta.url));
const image = new Resvg(svg, { fitTo: { mode: "width", value: 256 } }).render();
await writeFile(new URL("icon.png", import.meta.url), image.asPng());
