//! `lancer assemble`, `disassemble` and `run`.

use super::session::Session;

/// Sums 10 + 9 + ... + 1 and squares the sum.
const SUM: &str = "\
    movi s1, 10
    mov  s2, s0
1:  iadd s2, s2, s1
    isubi s1, s1, 1
    bnez s1, 1b
    call s31, square
    halt
.func square
    imul s3, s2, s2
    ret  s31
.endfunc
";

#[test]
fn words_survive_the_way_through_text() {
    let session = Session::new();
    session.write("sum.s", SUM);
    assert_eq!(session.succeed("assemble sum.s"), "sum.s: 9 words, 0 octets of data\n");
    session.succeed("assemble sum.s -o sum.bin");
    session.succeed("assemble sum.s -o sum.hex");
    session.succeed("disassemble sum.bin -o again.s");
    assert_eq!(session.succeed("disassemble sum.hex"), String::from_utf8(session.read("again.s")).unwrap());
    session.succeed("assemble again.s -o again.bin");
    assert_eq!(session.read("again.bin"), session.read("sum.bin"));
    assert_eq!(session.read("sum.bin").len(), 36);
}

#[test]
fn a_listing_shows_words_beside_lines() {
    let session = Session::new();
    session.write("sum.s", SUM);
    let listing = session.succeed("assemble sum.s --list");
    let line = listing.lines().find(|line| line.contains("iadd")).unwrap();
    assert!(line.starts_with("  000002  ") && line.ends_with("3    1:  iadd s2, s2, s1"), "{line}");
    assert!(listing.contains("square"), "{listing}");
    assert_eq!(session.succeed("assemble sum.s --list=sum.lst --map=sum.map"), "");
    assert_eq!(session.read("sum.lst"), listing.as_bytes());
    let map = session.succeed("assemble sum.s --map");
    assert_eq!(session.read("sum.map"), map.as_bytes());
    assert!(map.contains("000007  square  sum.s:8") && map.contains("square (function, 2 words of its own)"), "{map}");
    assert_eq!(session.succeed("assemble sum.s --list --map"), format!("{listing}\n{map}"));
}

#[test]
fn a_source_with_errors_has_a_listing_and_nothing_else() {
    let session = Session::new();
    session.write("wrong.s", "    nop\n    vdto s4, v1, v2\n    halt\n");
    let run = session.run("assemble wrong.s --list --map -o wrong.o");
    assert_eq!(run.code, 1);
    let lines: Vec<&str> = run.out.lines().collect();
    assert!(lines[2].ends_with("2    \u{20}   vdto s4, v1, v2"), "{}", run.out);
    assert_eq!(lines[3], "**** error[E001]: `vdto` is not an instruction");
    assert!(lines[4].starts_with("  000002  "), "the addresses go on: {}", run.out);
    session.fail("assemble wrong.s --list=wrong.lst --map=wrong.map -o wrong.o --data wrong.dat", 1, "wrong.s:2:5");
    assert_eq!(session.read("wrong.lst"), run.out.as_bytes());
    assert_eq!(session.names(), ["wrong.lst", "wrong.s"]);
}

#[test]
fn an_object_file_is_the_whole_program() {
    let session = Session::new();
    session.write(
        "data.s",
        "    movi s1, table\n    lw s2, 4(s1)\n.func f\n    trap 7\n.endfunc\n.buffer\ntable: .word 1, 2\n",
    );
    session.succeed("assemble data.s -o data.o");
    let traps = |file: &str| {
        let run = session.run(&format!("run {file} --json"));
        let mut result: serde_json::Value = serde_json::from_str(&run.out).unwrap();
        result["program"] = serde_json::Value::Null;
        result["settings"]["file"] = serde_json::Value::Null;
        (run.code, result, run.messages)
    };
    let object = traps("data.o");
    assert_eq!(object, traps("data.s"));
    assert_eq!((&object.1["registers"]["s2"], &object.1["trap"]["place"]), (&2.into(), &"data.s:4".into()));
    // The line itself is in the message although the source is gone.
    std::fs::remove_file(session.path("data.s")).unwrap();
    let run = session.run("run data.o");
    assert!(run.code == 3 && run.messages.contains("    trap 7"), "{}", run.messages);
    std::fs::copy(session.path("data.o"), session.path("named")).unwrap();
    assert_eq!(session.run("run named").code, 3, "an object file is known by its first octets");
    assert!(session.succeed("disassemble named").contains("trap"));
    session.fail("run data.o -D X=1", 2, "is assembled already");
}

/// A program with formats, names, and a function.
const REAL: &str = "\
    .format pos, 16
    .format dir, 30
    .reg   edge, s2
    .holds edge, pos
    .holds v1, dir
    mul    edge, s5, s5, pos
    call   s31, halve
    halt
.func halve
    .holds s3, pos
    srai   s3, edge, 1
    ret    s31
.endfunc
";

#[test]
fn registers_are_set_and_shown_as_real_numbers() {
    let session = Session::new();
    session.write("real.s", REAL);
    session.succeed("assemble real.s -o real.o");
    for file in ["real.s", "real.o"] {
        let run = format!("run {file} --reg s5=1.5:pos,v1=0.6:0:0.8:dir,s9=100,000,w1=0xffff_ffff_ffff_fff9");
        let text = session.succeed(&format!("{run} --show s2:pos,v1:dir,s3:15,edge,s9"));
        let row = |start: &str| text.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{text}"));
        assert!(row(" s2 ").contains("edge") && row(" s2 ").ends_with("2.25:pos"), "{text}");
        assert!(row(" v1 ").contains("644245094:0:858993459") && row(" v1 ").ends_with("0.6:0:0.8:dir"), "{text}");
        assert!(row(" s3 ").ends_with("2.25:15") && row(" s9 ").contains("100000"), "{text}");
        let result = session.json(&format!("{run} --show s2"));
        let shown = &result["shown"][0];
        assert_eq!((&shown["name"], &shown["raw"], &shown["real"]), (&"edge".into(), &147_456.into(), &2.25.into()));
        assert_eq!(result["registers"]["w1"], -7);
        let dumped = session.json(&format!("{run} --dump regs"));
        assert!(dumped["registers"].get("s6").is_none() && dumped["shown"].as_array().unwrap().len() > 5);
        let all = session.json(&format!("{run} --dump regs:all"));
        assert_eq!((all["registers"].as_object().unwrap().len(), &all["registers"]["s6"]), (72, &0.into()));
    }
    session.fail("run real.s --show s2:poss", 2, "did you mean `pos`?");
    session.fail("run real.s --reg edgy=1", 2, "did you mean `edge`?");
    session.fail("run real.s --reg s1=1.5", 2, "say its format");
    session.fail("run real.s --reg s1=1234,567", 2, "write 1234_567");
}

#[test]
fn a_trace_has_a_line_an_instruction() {
    let session = Session::new();
    session.write("real.s", REAL);
    let run = "run real.s --reg s5=1.5:pos";
    let result = session.json(run);
    let text = session.succeed(&format!("{run} --trace -"));
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len() as u64, 1 + result["instructions"].as_u64().unwrap(), "{text}");
    for part in ["real.s:6", "mul s2, s5, s5, 16", "s5=98304", "-> s2[edge]=147456 (2.25:pos)", "| Done"] {
        assert!(lines[1].contains(part), "{part}: {}", lines[1]);
    }
    assert!(lines[3].contains(" halve ") && lines[3].contains("-> s3=73728 (1.125:pos)"), "{text}");
    let mut both = session.json(&format!("{run} --trace a.jsonl --window function=halve"));
    both["settings"] = result["settings"].clone();
    assert_eq!(both, result, "a trace changes no result");
    let trace = String::from_utf8(session.read("a.jsonl")).unwrap();
    let records: Vec<serde_json::Value> = trace.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(records.iter().map(|record| record["step"].as_u64().unwrap()).collect::<Vec<_>>(), [2, 3]);
    // Clocks and transfers are those of the run; what goes wrong ends the trace.
    session.write("bus.s", "    movi s1, 8\n    stw s1, 4(s1)\n    ldw s2, 4(s1)\n    lw s3, -8(s0)\n");
    let run = session.run("run bus.s --trace a.jsonl --json");
    let result: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    let trace = String::from_utf8(session.read("a.jsonl")).unwrap();
    let last: serde_json::Value = serde_json::from_str(trace.lines().last().unwrap()).unwrap();
    assert_eq!((run.code, &last["clock"], &last["fault"]), (3, &result["clocks"], &result["trap"]["fault"]));
    assert!(trace.lines().nth(2).unwrap().contains(r#""transfer":{"address":12,"octets":4,"kind":"read"}"#), "{trace}");
    session.fail("run real.s --window steps=1", 2, "--trace");
    session.fail("run real.s --trace real.s", 2, "is read");
}

#[test]
fn one_instruction_has_a_page_of_the_manual() {
    let session = Session::new();
    let page = session.succeed("manual vdot");
    assert!(page.starts_with("vdot d, a, b, i") && page.contains("example:"), "{page}");
    assert_eq!(session.succeed("explain vdot"), page);
    assert!(session.succeed("manual .holds").contains("(directive)"));
    assert!(session.succeed("explain li").contains("movhi d, high(i)"));
    session.fail("manual vdto", 1, "did you mean `vdot`?");
    session.fail("explain vdto", 1, "did you mean `vdot`?");
    session.fail("manual vdot --as html", 2, "no other form");
}

#[test]
fn flags_name_the_lines_whose_results_lose_something() {
    let session = Session::new();
    session
        .write("lossy.s", "    movi s1, 3\n    movi s2, 2\n    div s3, s1, s2, 0\n    mul s4, s1, s2, 0\n    halt\n");
    let run = session.run("run lossy.s --flags");
    let row = " lossy.s:3 |         div |        1 |         1 |          0\n";
    assert!(run.code == 0 && run.out.contains(row), "{}", run.out);
    let flags = &session.json("run lossy.s --flags")["flags"];
    let expected = serde_json::json!([
        {"pc": 2, "place": "lossy.s:3", "instruction": "div", "executed": 1, "quantized": 1, "overflowed": 0}
    ]);
    assert_eq!(*flags, expected);
    assert!(session.json("run lossy.s").get("flags").is_none());
}

#[test]
fn words_alone_run_from_their_first() {
    let session = Session::new();
    session.write("sum.s", SUM);
    session.succeed("assemble sum.s -o sum.hex");
    session.succeed("assemble sum.s -o sum.bin");
    for file in ["sum.hex", "sum.bin"] {
        let result = session.json(&format!("run {file}"));
        assert_eq!((&result["registers"]["s3"], &result["instructions"]), (&3025.into(), &36.into()), "{file}");
        assert!(result["functions"].as_array().unwrap().is_empty());
    }
    assert!(session.read("sum.hex").starts_with(b"// 9 words of 32 bits\n"));
    session.write("data.s", "    halt\n.buffer\n.byte 1, 255\n");
    session.succeed("assemble data.s -o a.hex --data data.hex");
    assert_eq!(session.read("data.hex"), b"// 2 octets\n01 ff\n");
}

#[test]
fn damaged_object_files_are_refused() {
    let session = Session::new();
    session.write("sum.s", SUM);
    session.succeed("assemble sum.s -o sum.o");
    let whole = session.read("sum.o");
    let write = |octets: &[u8]| std::fs::write(session.path("bad.o"), octets).unwrap();
    let mut other = whole.clone();
    other[30] ^= 1;
    write(&other);
    session.fail("run bad.o", 1, "bad.o: the object file is damaged: its checksum does not hold");
    other = whole.clone();
    other[8] = 9;
    write(&other);
    session.fail("run bad.o", 1, "version 9 of the format, but only 1 to 3 are known");
    for end in [0, 5, 9, 12, 20, 60, whole.len() - 1] {
        write(&whole[..end]);
        session.fail("run bad.o", 1, "bad.o: ");
        session.fail("disassemble bad.o", 1, "bad.o: ");
    }
    write(SUM.as_bytes());
    session.fail("run bad.o", 1, "bad.o: this is not an object file of lancer");
}

#[test]
fn all_errors_of_a_source_come_in_one_run() {
    let session = Session::new();
    session.write(
        "wrong.s",
        "    vdto s4, v1, v2\n    movi s1, 99999999\n    jump nowhere\n    iadd s1\n    iadd s1, s2, v3\n",
    );
    let run = session.run("assemble wrong.s -o wrong.bin");
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    for line in 1..=5 {
        assert!(run.messages.contains(&format!("wrong.s:{line}:")), "line {line} in\n{}", run.messages);
    }
    assert!(run.messages.contains("did you mean `vdot`?") && run.messages.contains("5 errors"), "{}", run.messages);
    assert_eq!(session.names(), ["wrong.s"]);
}

#[test]
fn includes_definitions_and_data() {
    let session = Session::new();
    std::fs::create_dir_all(session.path("parts/inner")).unwrap();
    session.write("main.s", ".include \"one.inc\"\n.include \"inner/two.inc\"\n    movi s1, SIZE + ONE + TWO\n    halt\n.buffer\n.word 1, 2, 3\n");
    session.write("one.inc", ".equ ONE, 1\n");
    session.write("parts/inner/two.inc", ".equ TWO, 2\n");
    session.fail("assemble main.s -D SIZE=0x10", 1, "inner/two.inc");
    let run = session.run("assemble main.s -D SIZE=0x10 -I parts -o main.bin");
    assert!(run.code == 0 && run.messages.contains("12 octets of data"), "{}", run.messages);
    session.succeed("assemble main.s -D SIZE=0x10 -I parts -o main.bin --data main.dat");
    assert_eq!(session.read("main.dat"), [1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0]);
    assert_eq!(session.json("run main.s -D SIZE=0x10 -I parts")["registers"]["s1"], 19);
    session.fail("assemble main.s -o main.s.bin --data main.s", 2, "would be overwritten");
}

#[test]
fn a_program_runs_with_registers_and_memory_of_the_user() {
    let session = Session::new();
    session.write("sum.s", SUM);
    let result = session.json("run sum.s --reg v2=1:0x10:-3,w1=-7");
    assert_eq!(result["registers"], serde_json::json!({ "s2": 55, "s3": 3025, "s31": 6, "v2": [1, 16, -3], "w1": -7 }));
    assert_eq!((&result["instructions"], &result["counts"]["mul"]), (&36.into(), &1.into()));
    assert_eq!((&result["functions"][0]["name"], &result["functions"][0]["calls"]), (&"square".into(), &1.into()));
    assert!(result["trap"].is_null());
    session.write("copy.s", "    load s0, s1, s2\n    movi s3, 0x200\n    store s3, s0, s2\n    halt\n");
    session.write("in.dat", "abcdefgh");
    let copied = session.json("run copy.s --reg s1=0x100,s2=8 --mem 0x100=in.dat --dump 0x200:8 --dump buffer:0:4");
    assert_eq!(copied["dumps"][0]["octets"], "6162636465666768");
    assert_eq!((&copied["dumps"][1]["space"], &copied["dumps"][1]["octets"]), (&"buffer".into(), &"61626364".into()));
    assert_eq!((&copied["counts"]["octet"], &copied["waiting"]), (&16.into(), &32.into()));
    let text = session.succeed("run sum.s --dump regs:all");
    assert!(text.contains("3025") && text.contains("0x00000bd1") && text.contains(" w7 "), "{text}");
    assert!(!session.succeed("run sum.s --dump regs").contains(" w7 "));
    assert!(text.contains("halted after 36 instructions, 31 clocks"), "{text}");
}

#[test]
fn traps_and_step_limits_have_codes_and_places() {
    let session = Session::new();
    session.write("trap.s", "    nop\n.func f\n    movi s1, 3\n    trap 7\n.endfunc\n");
    session.write("loop.s", "1:  jump 1b\n");
    session.write("far.s", "    movi s1, -4\n    lw s3, (s1)\n    halt\n");
    for (arguments, code, place) in
        [("run trap.s", 3, "trap.s:4"), ("run loop.s --max-steps 100", 5, "loop.s:1"), ("run far.s", 3, "far.s:2")]
    {
        let run = session.run(arguments);
        assert_eq!(run.code, code, "{arguments}: {}", run.messages);
        assert!(run.messages.contains(place), "{arguments}: {}", run.messages);
        assert!(run.out.contains("stopped after"), "the registers are shown all the same: {}", run.out);
    }
    let run = session.run("run trap.s --json");
    let result: serde_json::Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!((&result["trap"]["function"], &result["trap"]["pc"]), (&"f".into(), &2.into()));
    assert!(run.messages.contains("trap 7"), "{}", run.messages);
}

#[test]
fn files_of_other_kinds_are_refused() {
    let session = Session::new();
    session.write("odd.bin", "12345");
    session.write("wrong.hex", "12345678\nxyz\n");
    session.fail("disassemble odd.bin", 1, "no whole words");
    session.fail("disassemble wrong.hex", 1, "wrong.hex:2:1");
    session.write("a.bin", "");
    session.fail("disassemble a.bin -o a.bin", 2, "would be overwritten");
}

#[test]
fn a_run_says_what_executed_it_and_gives_the_same_whatever_that_was() {
    let session = Session::new();
    session.write("p.s", "    li s1, 7\n    mul s2, s1, s1, 0\n    halt\n");
    let checked = session.json("run p.s --engine checked");
    for (options, engine) in
        [("", "native"), ("--engine native", "native"), ("--engine fast", "native"), ("--engine checked", "checked")]
    {
        let mut run = session.json(&format!("run p.s {options}"));
        assert_eq!(run["engine"], engine, "{options}");
        run["engine"] = checked["engine"].clone();
        run["settings"]["engine"] = checked["settings"]["engine"].clone();
        assert_eq!(run, checked, "{options}");
    }
    let [native, checked] =
        ["native", "checked"].map(|engine| session.json(&format!("run p.s --flags --engine {engine}")));
    assert_eq!((&native["engine"], &native["flags"]), (&"native".into(), &checked["flags"]));
}
