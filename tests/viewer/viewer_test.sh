#!/usr/bin/env bash
# viewer_test.sh LUMEL SAMPLES SOURCE BINARY: bakes the sample and looks at it with stock three.js and
# Babylon.js in a real browser.
# Skipped (77) without node, npm, a browser or the registry.
set -euo pipefail
lumel=$1 samples=$2 source=$3 work=$4
command -v node >/dev/null && command -v npm >/dev/null || { echo "no node: skipped"; exit 77; }

mkdir -p "$work"
cd "$work"
cp "$source/package.json" .
npm install --no-audit --no-fund --ignore-scripts --no-package-lock --silent || { echo "no npm packages: skipped"; exit 77; }

"$samples" scenes gallery
"$lumel" bake scenes/gallery.glb -o out --preset preview --samples 32 --texels-per-metre 8 --views 0 --progress none
"$lumel" render scenes/gallery.glb --baked out -o view.pfm --camera entrance --resolution 320x180 --samples 16 --progress none

# The documentation prints the loader that is tested here.
node -e 'const read = (f) => require("fs").readFileSync(f, "utf8"), code = read(process.argv[1]);
         process.exit(read(process.argv[2]).includes(code.slice(code.indexOf("export"))) ? 0 : 1)' \
    "$source/../../integrations/three/lightmap.js" "$source/../../docs/formats.md" || { echo "docs/formats.md differs"; exit 1; }

check() {
    node "$source/check.mjs" --out out --modules node_modules --camera entrance --reference view.pfm \
        --max-missing 0.001 "$@"
}
# Eight bits in sRGB: steps of about one percent.
check --mode plain --max-median 0.02 --png plain.png
check --viewer babylon --max-median 0.02 --png babylon.png
# three.js takes the energy of its specular lobe off the diffuse light: some 3 percent on rough dielectrics.
check --mode lightmap --max-median 0.05 --png lightmap.png
