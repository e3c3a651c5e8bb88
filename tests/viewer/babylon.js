// Runs in the browser: loads /out/scene.glb into stock Babylon.js as any page would and renders one view of it to floats.
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import '@babylonjs/core/Loading/loadingScreen.js';
import { AppendSceneAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { RenderTargetTexture } from '@babylonjs/core/Materials/Textures/renderTargetTexture.js';
import { Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Scene } from '@babylonjs/core/scene.js';
import '@babylonjs/loaders/glTF/2.0/index.js';
import { asText, canvasError } from '/picture.js';

function findCamera(scene, name) {
  const found = scene.cameras.find((camera) => camera.name === name || camera.parent?.name === name);
  if (!found) throw new Error(`no camera ${name} among ${scene.cameras.map((camera) => camera.name)}`);
  return found;
}

// Babylon.js is left-handed: its loader turns glTF's (x, y, z) into (-x, y, z).
const turned = ([x, y, z]) => new Vector3(-x, y, z);

function placedCamera(scene, { eye, target, fov }) {
  const camera = new FreeCamera('view', turned(eye), scene);
  camera.setTarget(turned(target));
  camera.fov = (fov * Math.PI) / 180;
  camera.minZ = 0.01;
  camera.maxZ = 10000;
  return camera;
}

window.renderView = async ({ view, width, height }) => {
  const canvas = Object.assign(document.createElement('canvas'), { width, height });
  const engine = new Engine(canvas, false, { preserveDrawingBuffer: true });
  const scene = new Scene(engine);
  scene.clearColor = new Color4(0, 0, 0, 0); // tells background from black
  await AppendSceneAsync('/out/scene.glb', scene);
  scene.activeCamera = view.name ? findCamera(scene, view.name) : placedCamera(scene, view);
  await scene.whenReadyAsync();
  // What a visitor of a page sees.
  scene.render();
  const png = canvas.toDataURL('image/png');
  const counts = { triangles: scene.getActiveIndices() / 3, lights: scene.lights.length };
  // A float target: linear radiance, no tone curve, no sRGB.
  scene.imageProcessingConfiguration.applyByPostProcess = true;
  const floats = new RenderTargetTexture('floats', { width, height }, scene, { type: Engine.TEXTURETYPE_FLOAT });
  floats.renderList = scene.meshes;
  floats.activeCamera = scene.activeCamera;
  floats.clearColor = scene.clearColor;
  scene.customRenderTargets.push(floats);
  await scene.whenReadyAsync();
  scene.render();
  const pixels = await floats.readPixels();
  const canvas_error = await canvasError(png, pixels, width, height);
  return { pixels: asText(pixels), png, counts: { ...counts, canvas_error } };
};
