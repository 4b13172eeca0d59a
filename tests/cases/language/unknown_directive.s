        .wrod 5                 ; error E002: `.wrod` is not a directive
