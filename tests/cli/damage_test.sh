#!/usr/bin/env bash
# Whatever bit of a scene flips and wherever it ends: `lumel bake` and `info` end by themselves with 0, 1 or 2 in 10 s
# and 2 GB. The loader alone meets many more damaged files (DamagedFiles.*); here all that comes after it does.
#   damage_test.sh LUMEL [sanitized]    sanitized: a sanitizer reserves terabytes of addresses, so none are counted
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"
ceiling=$((2 << 20)) # kB of addresses: more than what is resident
[ "${2:-}" != sanitized ] || ceiling=unlimited

# A scene of all that a bake writes: JSON and binary chunk, images, TEXCOORD_1, a light. Some 5 kB.
expect 0 '' bake ok.gltf -o lit "${quick[@]}"
whole=lit/scene.glb size=$(stat -c %s lit/scene.glb)

# run NAME COMMAND...: within the limits.
done_well=0 refused=0
run() {
    local name=$1 code
    shift
    (
        ulimit -v $ceiling
        exec timeout 10 "$lumel" "$@"
    ) >out.txt 2>err.txt
    code=$?
    case $code in
        0) done_well=$((done_well + 1)) ;;
        1 | 2)
            refused=$((refused + 1))
            grep -q '^lumel: error: ' err.txt || complain "$name: exit code $code without a word: $(cat err.txt)"
            ;;
        124) complain "$name: more than 10 s" ;;
        *) complain "$name: exit code $code: $(tail -n 3 err.txt)" ;;
    esac
    [ $code = 0 ] || [ ! -e baked ] || complain "$name: failed and left a folder"
    compgen -G 'baked*.partial-*' >/dev/null && complain "$name: left $(echo baked*)"
    rm -rf baked
}

# Bits of every step-th byte, the lowest, one in the middle or the highest in turn, so that numbers change little and much.
step=$((size / 60 + 1)) turn=0
for ((at = 0; at < size; at += step)); do
    bits=(1 8 128) bit=${bits[turn % 3]} turn=$((turn + 1))
    cp $whole damaged.glb
    byte=$(od -An -tu1 -j $at -N 1 $whole)
    printf '%b' "\\x$(printf %02x $((byte ^ bit)))" | dd of=damaged.glb bs=1 seek=$at conv=notrunc status=none
    run "byte $at of $size, bit $bit" bake damaged.glb -o baked "${quick[@]}"
done
flipped=$done_well
[ $flipped -gt 0 ] || complain 'no flipped bit is harmless: nothing but the loader was tried'
[ $refused -gt 0 ] || complain 'no flipped bit was noticed'

for ((length = 0; length < size; length += size / 20 + 1)); do
    head -c $length $whole >damaged.glb
    run "the first $length of $size bytes" bake damaged.glb -o baked "${quick[@]}"
    run "the first $length of $size bytes" info damaged.glb
done
[ $done_well = $flipped ] || complain 'a part was taken for a whole file'
echo "$((done_well + refused)) runs: $done_well done, $refused refused"
finish
