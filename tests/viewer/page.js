// Runs in the browser: loads /out/scene.glb as any page would and renders one view of it to floats.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { useLightmaps } from '/lightmap.js';
import { asText, canvasError } from '/picture.js';

function findCamera(root, name) {
  let found;
  root.traverse((object) => { if (object.isCamera && object.name === name) found = object; });
  if (!found) throw new Error(`no camera ${name}`);
  return found;
}

// mode: 'plain' shows the file as it is; 'lightmap' puts the original materials back, lit by the HDR lightmaps.
window.renderView = async ({ mode, view, width, height }) => {
  const renderer = new THREE.WebGLRenderer();
  renderer.setClearAlpha(0); // tells background from black
  const gltf = await new GLTFLoader().loadAsync('/out/scene.glb');
  if (mode === 'lightmap') await useLightmaps(gltf, '/out/');
  const scene = new THREE.Scene();
  scene.add(gltf.scene);
  const camera = view.name ? findCamera(gltf.scene, view.name) : new THREE.PerspectiveCamera(view.fov, 1, 0.01, 10000);
  if (!view.name) {
    camera.position.set(...view.eye);
    camera.lookAt(...view.target);
  }
  camera.aspect = width / height;
  camera.updateProjectionMatrix();
  // A float target: linear radiance, no tone curve, no sRGB.
  const floats = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType });
  renderer.setRenderTarget(floats);
  renderer.render(scene, camera);
  const pixels = new Float32Array(width * height * 4);
  renderer.readRenderTargetPixels(floats, 0, 0, width, height, pixels);
  const counts = { calls: renderer.info.render.calls, triangles: renderer.info.render.triangles };
  // And what a visitor of a page sees.
  renderer.setRenderTarget(null);
  renderer.setSize(width, height);
  renderer.render(scene, camera);
  const png = renderer.domElement.toDataURL('image/png');
  const canvas_error = await canvasError(png, pixels, width, height);
  return { pixels: asText(pixels), png, counts: { ...counts, canvas_error } };
};
