; machine: cores = 0
; machine: bus.octets_per_beat = 0
; error: `cores` is 0, but must lie in 1..=256
; error: `bus.octets_per_beat` is 0, but must lie in 1..=1000000
        halt
