#!/usr/bin/env bash
# lumel atlas, and --atlas of bake: what is written, what is kept, and what is said where it cannot be.
#   atlas_test.sh LUMEL
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"

# The number at a key of a JSON file, of whichever object has it first.
number() { grep -o "\"$2\": *[0-9.e+-]*" "$1" | head -1 | sed 's/.*: *//'; }

expect 0 '' atlas ok.gltf -o flat --texels-per-metre 16
for file in atlas.json atlas_charts_0.png atlas_waste_0.png atlas_density_0.png atlas_stretch_0.png; do
    [ -s "flat/$file" ] || complain "atlas wrote no $file"
done
grep -q 'flat: 1 charts on 1 page, 1089 texels of ' out.txt || complain "the summary is: $(cat out.txt)"
grep -q 'L2 stretch 1.0000' out.txt || complain "the summary says nothing of stretch: $(cat out.txt)"

# No light is needed, and the same options give the layout of a bake.
sed 's/,{"translation.*}}}\]/]/; s/\[0,1\]/[0]/' ok.gltf >dark.gltf
expect 0 '' atlas dark.gltf -o dark --texels-per-metre 16
expect 0 '' bake ok.gltf -o out --texels-per-metre 16 --preset preview --samples 1 --views 0 --threads 1
layout() { grep '"charts": {"id"' "$1"; }
[ -n "$(layout out/manifest.json)" ] || complain 'the manifest has no charts'
[ "$(layout out/manifest.json)" = "$(layout flat/atlas.json)" ] || complain 'bake and atlas lay out differently'

# Into the folder of a bake: the bake stays, an older atlas goes. Pictures of the same name that are of no atlas stay, too.
touch out/atlas_charts_5.png
expect 1 'out' atlas ok.gltf -o out/ --texels-per-metre 16
[ -e out/atlas_charts_5.png ] || complain 'atlas took a picture away that is not its own'
rm out/atlas_charts_5.png
expect 0 '' atlas ok.gltf -o out/ --texels-per-metre 16
touch out/atlas_charts_5.png
expect 0 '' atlas ok.gltf -o out/ --texels-per-metre 16
[ -s out/manifest.json ] && [ -s out/scene.glb ] || complain 'atlas took the bake away'
[ -e out/atlas_charts_5.png ] && complain 'a page of an older atlas stayed'

# Keeping a layout: with the atlas, and with the manifest of the folder that is replaced.
again=(--preset preview --samples 1 --views 0 --threads 1)
expect 0 '' bake ok.gltf -o kept --atlas flat/atlas.json "${again[@]}"
grep -qx '1 of 1 charts lie where flat/atlas.json has them' out.txt || complain "bake does not say what it kept: $(cat out.txt)"
[ "$(layout kept/manifest.json)" = "$(layout flat/atlas.json)" ] || complain 'the layout was not kept'
[ "$(number kept/manifest.json kept_charts)" = 1 ] || complain 'the manifest does not say what was kept'
expect 0 '' bake ok.gltf -o kept --atlas kept/manifest.json "${again[@]}"
[ "$(layout kept/manifest.json)" = "$(layout flat/atlas.json)" ] || complain 'the layout was not kept twice'
expect 0 '' atlas ok.gltf -o again --atlas flat/atlas.json
[ "$(layout again/atlas.json)" = "$(layout flat/atlas.json)" ] || complain 'atlas did not keep the layout'

# Layouts for other lookups: recorded, and gone on with.
expect 0 '' atlas ok.gltf -o mips --texels-per-metre 16 --mips 2 --filter bicubic
grep -q '"filter": "bicubic"' mips/atlas.json && [ "$(number mips/atlas.json mips)" = 2 ] || complain 'lookups are not recorded'
expect 0 '' bake ok.gltf -o kept --atlas mips/atlas.json "${again[@]}"
[ "$(layout kept/manifest.json)" = "$(layout mips/atlas.json)" ] || complain 'a layout for mips was not kept'
for mip in 1 2; do
    for kind in lightmap irradiance l1 master; do
        [ -s "kept/${kind}_0_mip$mip.exr" ] || complain "bake wrote no ${kind} of mip $mip"
    done
done
[ -e kept/lightmap_0_mip3.exr ] && complain 'bake wrote a mip that nobody asked for'
expect 2 'leave out --filter, --mips and --block, or --atlas' atlas ok.gltf -o no --atlas mips/atlas.json --mips 3
expect 0 '' bake ok.gltf -o kept --atlas flat/atlas.json "${again[@]}"
[ -e kept/lightmap_0_mip1.exr ] && complain 'mips of an older bake stayed'
expect 2 '--mips' atlas ok.gltf -o no --mips 7
expect 2 '--block' atlas ok.gltf -o no --block 2
expect 2 'no whole number of cells of 16' atlas ok.gltf -o no --mips 4 --resolution 100x100

# Pages by place, and even charts.
expect 0 '' atlas ok.gltf -o pages --texels-per-metre 16 --pages cluster
[ "$(layout pages/atlas.json)" = "$(layout flat/atlas.json)" ] || complain 'one object has another layout by place'
expect 2 '--pages' atlas ok.gltf -o no --pages 0
expect 2 '--pages' atlas ok.gltf -o no --pages near
expect 2 '--resolution' atlas ok.gltf -o no --pages 2 --resolution 64x64
expect 2 '--atlas' atlas ok.gltf -o no --pages 2 --atlas flat/atlas.json
expect 0 '' bake ok.gltf -o even --texels-per-metre 16 --collapse 0.01 "${again[@]}"
grep -q 'of 1 charts are even enough' out.txt || complain "bake does not say what collapsed: $(cat out.txt)"
expect 2 '--collapse' bake ok.gltf -o no --collapse 0.01 --resolution 64x64 "${again[@]}"

# Where it cannot be kept.
expect 2 '--texels-per-metre asks for 8' atlas ok.gltf -o no --atlas flat/atlas.json --texels-per-metre 8
expect 2 '--resolution' bake ok.gltf -o no --atlas flat/atlas.json --resolution 64x64 "${again[@]}"
expect 0 '' atlas ok.gltf -o large --texels-per-metre 100
expect 2 'more than --max-page 64' atlas ok.gltf -o no --atlas large/atlas.json --max-page 64
expect 1 'gone.json' atlas ok.gltf -o no --atlas gone.json
expect 1 'describes no pages' atlas ok.gltf -o no --atlas ok.gltf
echo '{"pages": [' >broken.json
expect 1 'broken.json' bake ok.gltf -o no --atlas broken.json "${again[@]}"
sed 's/"charts": {"id":\[[^]]*\],/"charts": {/' flat/atlas.json >older.json
expect 1 'older Lumel' atlas ok.gltf -o no --atlas older.json
[ -e no ] && complain 'a failed run left its folder'

# Usage, and files that are not ours.
expect 2 '--output' atlas ok.gltf
expect 2 '--max-page' atlas ok.gltf -o no --max-page 3
expect 2 '' atlas ok.gltf -o no --samples 3
mkdir theirs
echo '{"frames": {}}' >theirs/atlas.json
expect 1 'theirs/atlas.json: exists and would be replaced' atlas ok.gltf -o theirs
sed 's/"name":"floor"},/"name":"floor","extras":{"lightmap":false}},/' ok.gltf >probe.gltf
expect 1 'no surface of the scene gets lightmap texels' atlas probe.gltf -o no
[ -e no ] && complain 'a failed run left its folder'

finish
