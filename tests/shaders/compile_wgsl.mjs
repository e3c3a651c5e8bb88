// Compiles a WGSL text in Chromium's WebGPU: node compile_wgsl.mjs FILE
// Exit code 77 where there is no Chromium, or it has no WebGPU adapter.
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const kSkipped = 77;
const kSecondsToWait = 90;

const page = `<script type="module">
const report = (result) => fetch('/result', { method: 'POST', body: JSON.stringify(result) });
try {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) {
    await report({ skipped: 'no WebGPU adapter' });
  } else {
    const device = await adapter.requestDevice();
    const module = device.createShaderModule({ code: await (await fetch('/text.wgsl')).text() });
    const { messages } = await module.getCompilationInfo();
    const errors = messages.filter((m) => m.type === 'error').map((m) => m.lineNum + ': ' + m.message);
    if (!errors.length) await device.createComputePipelineAsync({ layout: 'auto', compute: { module, entryPoint: 'main' } });
    await report({ errors });
  }
} catch (error) {
  await report({ errors: [String(error)] });
}
</script>`;

const chromium = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(
  (path) => path && existsSync(path),
);
if (!chromium) {
  console.log('no Chromium: skipped');
  process.exit(kSkipped);
}
const text = readFileSync(process.argv[2], 'utf8');
const profile = mkdtempSync(join(tmpdir(), 'lumel-wgsl-'));

const code = await new Promise((resolve) => {
  const server = createServer((request, response) => {
    if (request.url === '/text.wgsl') return response.end(text);
    if (request.url !== '/result') return response.writeHead(200, { 'Content-Type': 'text/html' }).end(page);
    let body = '';
    request.on('data', (part) => (body += part));
    request.on('end', () => {
      response.end();
      const { skipped, errors } = JSON.parse(body);
      console.log(skipped ? `${skipped}: skipped` : errors.length ? errors.join('\n') : 'compiles in WebGPU');
      resolve(skipped ? kSkipped : errors.length ? 1 : 0);
    });
  });
  server.listen(0, '127.0.0.1', () => {
    const browser = spawn(chromium, [
      '--headless=new', '--no-sandbox', `--user-data-dir=${profile}`, '--enable-unsafe-webgpu',
      '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan', '--use-vulkan=swiftshader',
      `http://127.0.0.1:${server.address().port}/`,
    ], { stdio: 'ignore', detached: true });
    const stop = () => {
      try {
        process.kill(-browser.pid, 'SIGKILL');
      } catch {
        // It ended by itself.
      }
    };
    process.on('exit', stop);
    browser.on('error', () => resolve(kSkipped));
  });
  setTimeout(() => {
    console.log(`no answer from Chromium within ${kSecondsToWait} s`);
    resolve(1);
  }, kSecondsToWait * 1000);
});
process.on('exit', () => rmSync(profile, { recursive: true, force: true, maxRetries: 5 }));
process.exit(code);
