#!/usr/bin/env bash
# `lumel encode`: other encodings of a bake, the table of all, faults of usage.
#   encode_test.sh LUMEL
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"

expect 0 '' bake ok.gltf -o lit "${quick[@]}" --progress none

expect 0 '' encode lit --encoding irradz-hhd
[ -s lit/encoded_irradz-hhd_0.exr ] || complain 'no page'
printf 'description: lit/encoded_irradz-hhd.json\nlight: lit/encoded_irradz-hhd_0.exr\n' | cmp -s - out.txt ||
    complain "the files are not named: $(cat out.txt)"
grep -q '"frame": "tangent"' lit/encoded_irradz-hhd.json || complain 'the frame is not stated'
expect 0 '' encode lit --encoding l1-hhd -o elsewhere
[ -s elsewhere/encoded_l1-hhd_0.exr ] || complain 'no page elsewhere'
grep -q '"frame": "world"' elsewhere/encoded_l1-hhd.json || complain 'the frame is not stated'

# Plain irradiance is the bake's own.
expect 0 '' encode lit --encoding irradiance
expect 0 '' compare lit/encoded_irradiance_0.exr lit/lightmap_0.exr --max-error 1e-6

expect 0 '' encode lit --table --table-texels 50
[ "$(wc -l <out.txt)" -gt 60 ] || complain "the table is short: $(cat out.txt)"
cut -d, -f5- out.txt | grep -qiE 'nan|inf' && complain 'the table has numbers that are none'
expect 0 'bytes a texel' encode lit --encoding auto --max-bytes 12 --table-texels 50
expect 2 'no encoding fits' encode lit --encoding auto --max-bytes 2 --format exr --table-texels 50
expect 0 '' encode lit --table --table-texels 50 --quality fast --plot plot.png
[ -s plot.png ] || complain 'no plot'
for row in l1-hazel,bc7,4 l1-hazel,bc1,2.5 irradz-hhd,bc45,2.5 irradz-hhd,bc7,2 irradiance,bc7,1 l2,half,54; do
    grep -q "^$row," out.txt || complain "no row $row in the table"
done
grep -q '^hlsh,rgb9e5' out.txt && complain 'rgb9e5 holds no negative light'

# Textures. Those of a format go when another comes.
expect 0 '' encode lit --encoding irradz-hhd --format ktx2
[ -s lit/encoded_irradz-hhd_w-d.ktx2 ] || complain 'no texture'
[ -e lit/encoded_irradz-hhd_0.exr ] && complain 'the EXR file is left'
grep -qx 'light: lit/encoded_irradz-hhd_w-d.ktx2' out.txt || complain "the texture is not named: $(cat out.txt)"
grep -q '"vk_format": 143' lit/encoded_irradz-hhd.json || complain 'no vkFormat'
expect 0 '' encode lit --encoding irradz-hhd --format dds --storage bc45 --quality best --threads 2
[ "$(compgen -G 'lit/encoded_irradz-hhd_*.dds' | wc -l)" = 3 ] || complain 'not three textures'
[ -e lit/encoded_irradz-hhd_w-d.ktx2 ] && complain 'the KTX2 file is left'
cp lit/encoded_irradz-hhd_I.dds one.dds
expect 0 '' encode lit --encoding irradz-hhd --format dds --storage bc45 --quality best --threads 1
cmp one.dds lit/encoded_irradz-hhd_I.dds || complain 'threads make a difference'
expect 0 '' encode lit --encoding irradiance --format hdr
expect 0 '' compare lit/encoded_irradiance_I_0.hdr lit/lightmap_0.exr --max-error 1e-4
expect 0 '' encode lit --encoding l1-hhd --format png-rgbm
[ -s lit/encoded_l1-hhd_L1n-R_0.png ] || complain 'no PNG of ratios'
expect 0 'as ktx2' encode lit --encoding auto --max-bytes 4 --table-texels 50 -o chosen
expect 0 'as exr, half' encode lit --encoding auto --table-texels 50 -o chosen
expect 0 'as dds' encode lit --encoding auto --format dds --storage bc1 --table-texels 50 -o chosen

expect 2 'negative light, which rgbm cannot hold' encode lit --encoding hlsh --format png-rgbm
expect 2 '--storage needs' encode lit --encoding l2 --storage bc7
expect 2 '--storage needs' encode lit --encoding l1-hhd --format png-rgbd --storage bc7
expect 2 '--quality needs' encode lit --encoding l2 --quality best
expect 2 '--plot needs' encode lit --encoding l2 --plot plot.png
expect 2 'rgbm' encode lit --encoding l2 --format ktx2 --storage rgbm
expect 2 "there is no 'hhd'" encode lit --encoding hhd
expect 2 'one of --encoding and --table' encode lit
expect 2 'does not go with --encoding' encode lit --table --encoding l2
expect 2 '--max-bytes needs' encode lit --encoding l2 --max-bytes 4
expect 2 '--table prints' encode lit --table -o elsewhere
expect 2 '--table prints' encode lit --table --format exr
expect 2 '--table-texels needs' encode lit --encoding l2 --table-texels 50
expect 1 'nowhere: there is no such folder' encode nowhere --encoding l2
mkdir notes
expect 1 'notes: is no bake of lumel: it has no manifest.json (give the folder that' encode notes --encoding l2
compgen -G 'lit/.lumel-*' >/dev/null && complain "left $(echo lit/.lumel-*)"

# The encoded files are of this bake: they go when another takes its place, and those elsewhere stay.
expect 0 '' bake ok.gltf -o lit "${quick[@]}" --progress none
compgen -G 'lit/encoded_*' >/dev/null && complain "a new bake left $(echo lit/encoded_*)"
[ -s elsewhere/encoded_l1-hhd_0.exr ] || complain 'the page elsewhere is gone'

# Pages are those of the manifest.
sed -E 's/"width": ?32/"width": 31/' lit/manifest.json >changed.json
cmp -s changed.json lit/manifest.json && complain 'the manifest was not changed'
cp lit/manifest.json good.json
cp changed.json lit/manifest.json
expect 1 'the manifest says 31 x 32' encode lit --encoding l2
cp good.json lit/manifest.json
rm lit/master_0.exr
expect 1 'master_0.exr' encode lit --encoding l2
head -c 3000 lit/lightmap_0.exr >lit/master_0.exr
expect 1 'bake again' encode lit --encoding l2
compgen -G 'lit/encoded_*' >/dev/null && complain "failures left $(echo lit/encoded_*)"
finish
