done:   halt
done:   halt                    ; error E004: `done` is defined twice
