        .include "include_itself.s"
