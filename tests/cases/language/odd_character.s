        movi s1, 5 @ 3          ; error E013: the character `@` means nothing here
