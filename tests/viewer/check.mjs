// node check.mjs --out FOLDER --modules NODE_MODULES --camera NAME|'eye;target;fov' --reference VIEW.pfm
//                [--viewer three|babylon] [--mode plain|lightmap] [--max-median 0.02] [--max-missing 1]
//                [--png PICTURE.png]
// Renders FOLDER/scene.glb with stock three.js or Babylon.js in headless Chromium and compares with `lumel render --baked`
// of the same view. Exit code 0 agrees, 1 differs, 77 no browser.
import { createReadStream, existsSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import http from 'node:http';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const here = path.dirname(fileURLToPath(import.meta.url));
const { values: options } = parseArgs({
  options: {
    out: { type: 'string' },
    modules: { type: 'string' },
    camera: { type: 'string' },
    reference: { type: 'string' },
    viewer: { type: 'string', default: 'three' },
    mode: { type: 'string', default: 'plain' },
    'max-median': { type: 'string', default: '0.02' },
    'max-missing': { type: 'string', default: '1' },
    png: { type: 'string' },
  },
});
const require = createRequire(path.join(path.resolve(options.modules), 'x.js'));

const browser_path = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome']
  .find((file) => file && existsSync(file));
if (!browser_path) {
  console.log('no Chromium found: skipped');
  process.exit(77);
}

const kTypes = { '.html': 'text/html', '.js': 'text/javascript', '.glb': 'model/gltf-binary' };

// /modules/ is node_modules, /out/ the baked folder, the rest lies here.
function locate(url) {
  const name = decodeURIComponent(new URL(url, 'http://x').pathname);
  if (name.startsWith('/modules/')) return path.join(options.modules, name.slice(9));
  if (name.startsWith('/out/')) return path.join(options.out, name.slice(5));
  if (name === '/lightmap.js') return path.join(here, '../../integrations/three/lightmap.js');
  return path.join(here, name);
}

function serve() {
  const server = http.createServer((request, response) => {
    const file = locate(request.url);
    if (!existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': kTypes[path.extname(file)] ?? 'application/octet-stream' });
    createReadStream(file).pipe(response);
  });
  return new Promise((done) => server.listen(0, '127.0.0.1', () => done(server)));
}

// Rows of a colour PFM run from the bottom up, as those that WebGL reads back.
function readPfm(file) {
  const bytes = readFileSync(file);
  const [, width, height] = /^PF\s+(\d+)\s+(\d+)\s+-\S+\n/.exec(bytes.toString('latin1', 0, 64));
  const start = bytes.length - width * height * 12;
  const floats = new Float32Array(bytes.buffer.slice(bytes.byteOffset + start, bytes.byteOffset + bytes.length));
  return { width: Number(width), height: Number(height), floats };
}

function parseCamera(text) {
  if (!text.includes(';')) return { name: text };
  const [eye, target, fov] = text.split(';');
  return { eye: eye.split(',').map(Number), target: target.split(',').map(Number), fov: Number(fov) };
}

const percentile = (sorted, p) => sorted[Math.floor(p * (sorted.length - 1))];

// Relative error per pixel where both show something; alpha 0 is the background.
function compare(pixels, reference) {
  const errors = [];
  let sum = 0, reference_sum = 0, missing = 0;
  for (let i = 0; i < reference.width * reference.height; ++i) {
    let error = 0, size = 0, shown = 0;
    for (let c = 0; c < 3; ++c) {
      const r = reference.floats[3 * i + c], x = pixels[4 * i + c];
      error += Math.abs(x - r);
      size += r;
      shown += x;
    }
    if (size <= 0) continue;
    if (pixels[4 * i + 3] === 0) {
      ++missing; // the sky, which the file does not hold
      continue;
    }
    sum += Math.min(shown, 10 * size);
    reference_sum += size;
    errors.push(error / size);
  }
  errors.sort((a, b) => a - b);
  return {
    pixels: errors.length,
    missing,
    ratio_of_means: sum / reference_sum,
    median: percentile(errors, 0.5),
    p90: percentile(errors, 0.9),
  };
}

async function validate() {
  const report = await require('gltf-validator').validateBytes(new Uint8Array(readFileSync(path.join(options.out, 'scene.glb'))));
  console.log(`validator: ${report.issues.numErrors} errors, ${report.issues.numWarnings} warnings`);
  return report.issues.numErrors === 0;
}

const valid = await validate();
const server = await serve();
const browser = await require('playwright-core').chromium.launch({
  executablePath: browser_path,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-gpu',
    '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});
let failed = !valid;
try {
  const page = await browser.newPage();
  page.on('console', (message) => message.type() === 'error' && console.log(`page: ${message.text()}`));
  page.on('pageerror', (error) => console.log(`page: ${error}`));
  await page.goto(`http://127.0.0.1:${server.address().port}/${options.viewer === 'babylon' ? 'babylon' : 'page'}.html`);
  await page.waitForFunction(() => window.renderView);
  const reference = readPfm(options.reference);
  const { width, height } = reference;
  const request = { mode: options.mode, view: parseCamera(options.camera), width, height };
  const result = await page.evaluate((r) => window.renderView(r), request);
  if (options.png) writeFileSync(options.png, Buffer.from(result.png.split(',')[1], 'base64'));
  const bytes = Buffer.from(result.pixels, 'base64');
  const pixels = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  const figures = compare(pixels, reference);
  console.log(JSON.stringify({ viewer: options.viewer, mode: options.mode, ...result.counts, ...figures }));
  const all = reference.width * reference.height;
  const enough = figures.pixels > 0.1 * all && figures.missing <= Number(options['max-missing']) * all;
  const as_shown = result.counts.canvas_error <= 3; // Babylon.js: a power of 2.2 where three.js has sRGB's own curve
  failed ||= !as_shown || !enough || !(figures.median <= Number(options['max-median']));
} finally {
  await browser.close();
  server.close();
}
process.exit(failed ? 1 : 0);
