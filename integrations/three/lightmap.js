// Puts a baked scene's own materials back and lights them by its HDR lightmaps (three.js r152 and later).
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';

// `folder`: the URL of the output folder, with a slash at its end.
export async function useLightmaps(gltf, folder) {
  const { pages } = gltf.parser.json.extensions.LUMEL_lightmap, meshes = [];
  const maps = await Promise.all(pages.map((page) => new EXRLoader().loadAsync(folder + page.irradiance)));
  for (const map of maps) map.channel = 1, map.repeat.y = -1, map.offset.y = 1; // EXRLoader's rows run upwards
  gltf.scene.traverse((object) => object.material?.userData.lumel && meshes.push(object));
  for (const mesh of meshes) {
    const { original, page } = mesh.material.userData.lumel;
    mesh.material = await gltf.parser.getDependency('material', original);
    gltf.parser.assignFinalMaterial(mesh); // vertex colours, flat shading
    mesh.material = Object.assign(mesh.material.clone(), { lightMap: maps[page] });
  }
}
