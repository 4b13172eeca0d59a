        ; été
        .asciz «é»
été: nop
