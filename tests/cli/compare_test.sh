#!/usr/bin/env bash
# `lumel compare`: --max-error, --metric and --mask decide the exit code.
#   compare_test.sh LUMEL
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"

# grey FILE WORD: 4 x 4 pixels of 1 as PFM (big-endian, for the scale is positive), the last of them WORD.
grey() {
    local word
    {
        printf 'Pf\n4 4\n1.0\n'
        for word in $one $one $one $one $one $one $one $one $one $one $one $one $one $one $one "$2"; do
            printf '%b' "\x${word:0:2}\x${word:2:2}\x${word:4:2}\x${word:6:2}"
        done
    } >"$1"
}
two=40000000
grey truth.pfm $one
grey off.pfm $two
grey mask.pfm $zero
# The mask of the last pixel alone: all 0 but that one.
one=$zero grey inverse.pfm 3f800000

# One of 16 pixels is 2 in place of 1: nRMSE = sqrt(1/16) = 0.25, relMSE = (1 / 1.01) / 16 = 0.0619.
expect 0 '' compare off.pfm truth.pfm
grep -q '^nRMSE *0.25$' out.txt || complain "nRMSE is not 0.25: $(cat out.txt)"
expect 0 '' compare off.pfm truth.pfm --metric nrmse --max-error 0.2501
expect 1 'nrmse 0.25 is above 0.2499' compare off.pfm truth.pfm --metric nrmse --max-error 0.2499
grep -q '^nRMSE' out.txt || complain 'the figures are not printed above --max-error'
expect 0 '' compare off.pfm truth.pfm --metric relmse --max-error 0.062
expect 1 'is above 0.0618' compare off.pfm truth.pfm --metric relmse --max-error 0.0618
# relmse is what --max-error looks at by itself: 0.1 lies between the two.
expect 0 '' compare off.pfm truth.pfm --max-error 0.1
expect 1 'nrmse' compare off.pfm truth.pfm --metric nrmse --max-error 0.1
expect 1 'is above 0' compare off.pfm truth.pfm --max-error 0 --json
expect 0 '' compare truth.pfm truth.pfm --max-error 0

# The mask leaves the bad pixel out, or nothing but it.
expect 0 '' compare off.pfm truth.pfm --mask mask.pfm --metric nrmse --max-error 0
grep -q '^texels *15 ' out.txt || complain "not 15 texels: $(cat out.txt)"
expect 1 'nrmse 1 is above 0.99' compare off.pfm truth.pfm --mask inverse.pfm --metric nrmse --max-error 0.99
expect 0 '' compare off.pfm truth.pfm --mask inverse.pfm --metric nrmse --max-error 1

one=$zero grey black.pfm $zero
printf 'Pf\n1 1\n1.0\n\x3f\x80\0\0' >small.pfm
expect 1 'the mask leaves no texel' compare off.pfm truth.pfm --mask black.pfm
expect 1 'the mask is 1x1' compare off.pfm truth.pfm --mask small.pfm
expect 1 'must be of equal size' compare small.pfm truth.pfm
expect 1 'gone.pfm' compare gone.pfm truth.pfm --max-error 1
expect 2 --metric compare off.pfm truth.pfm --metric psnr
expect 2 --max-error compare off.pfm truth.pfm --max-error -1
expect 2 --max-error compare off.pfm truth.pfm --max-error nan
finish
