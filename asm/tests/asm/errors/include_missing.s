        .include "nothing.s"
        made_there s1
        j also_there
        .include nothing
