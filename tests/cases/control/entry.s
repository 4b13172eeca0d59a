; Execution starts at `start` where nothing else is said.
        trap 1
start:  movi s1, 3              ; s1 = 3
        halt
