// Draws glTF files in headless Chromium: node draw.mjs ENGINE,... CAMERA WIDTHxHEIGHT FILE [CAMERA WIDTHxHEIGHT FILE]...
// An engine is the name of a page: three, babylon or playcanvas. Writes FILE.CAMERA.ENGINE.png. Prints JSON:
// {ENGINE: [{meshes, materials, pixels}, ...]}. The pixels are bytes in base64: red, green, blue and alpha of an sRGB
// display, row by row from the top. A list of numbers would take the browser several times as long as the drawing.
import { createReadStream, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const [engines, ...views] = process.argv.slice(2);
let file;
const here = dirname(fileURLToPath(import.meta.url));
const types = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript" };

const server = createServer((request, response) => {
  const path = normalize(new URL(request.url, "http://localhost").pathname);
  const source = path.startsWith("/scene.") ? file
    : path.startsWith("/integrations/") ? join(here, "../..", path)
    : path.endsWith(".html") ? join(here, path)
    : join(here, "node_modules", path);
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
  const pictures = {};
  for (const engine of engines.split(",")) {
    const page = await browser.newPage();
    page.on("console", (message) => console.error(message.text()));
    page.on("pageerror", (error) => console.error(error.message));
    await page.goto(`http://127.0.0.1:${server.address().port}/${engine}.html`);
    await page.waitForFunction(() => window.draw);
    pictures[engine] = [];
    for (let i = 0; i < views.length; i += 3) {
      const [camera, size] = views.slice(i);
      file = views[i + 2];
      const { png, ...drawn } = await page.evaluate(
        (parameters) => window.draw(...parameters), [`/scene${extname(file)}`, camera, ...size.split("x").map(Number)]);
      writeFileSync(`${file}.${camera}.${engine}.png`, Buffer.from(png.split(",")[1], "base64"));
      pictures[engine].push(drawn);
    }
    await page.close();
  }
  console.log(JSON.stringify(pictures));
} finally {
  await browser.close();
  server.close();
}
