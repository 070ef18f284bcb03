// Draws glTF files with three.js in headless Chromium: node draw.mjs CAMERA WIDTH HEIGHT FILE... Writes FILE.png.
// Prints a JSON list: {meshes, materials, pixels}. The pixels are bytes in base64: red, green, blue and alpha of an sRGB
// display, row by row from the top. A list of numbers would take the browser several times as long as the drawing.
import { createReadStream, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const [camera, width, height, ...files] = process.argv.slice(2);
let file;
const here = dirname(fileURLToPath(import.meta.url));
const types = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript" };

const server = createServer((request, response) => {
  const path = normalize(new URL(request.url, "http://localhost").pathname);
  const source = path === "/scene" ? file
    : path.startsWith("/three/") ? join(here, "node_modules", path)
    : path === "/lightmap.js" ? join(here, "../../integrations/three", path)
    : join(here, path);
  response.setHeader("Cache-Control", "no-store");
  response.setHeader("Content-Type", types[extname(source)] ?? "application/octet-stream");
  createReadStream(source).on("error", () => response.writeHead(404).end()).pipe(response);
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));

const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  const page = await browser.newPage();
  page.on("console", (message) => console.error(message.text()));
  page.on("pageerror", (error) => console.error(error.message));
  await page.goto(`http://127.0.0.1:${server.address().port}/page.html`);
  await page.waitForFunction(() => window.draw);
  const pictures = [];
  for (file of files) {
    const { png, ...drawn } = await page.evaluate(
      ([name, w, h]) => window.draw(name, w, h), [camera, Number(width), Number(height)]);
    writeFileSync(`${file}.png`, Buffer.from(png.split(",")[1], "base64"));
    pictures.push(drawn);
  }
  console.log(JSON.stringify(pictures));
} finally {
  await browser.close();
  server.close();
}
