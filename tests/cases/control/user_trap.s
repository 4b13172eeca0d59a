; A trap of the program's own is counted like an end.
        trap 67108863           ; trap: trap 67108863; exit Done; count: jump 1
