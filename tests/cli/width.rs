//! Help and tables in terminals of 80 and 120 columns, looked at through a pseudo-terminal.
#![cfg(unix)]

use std::fs::File;
use std::io::{Read, Write};
use std::os::fd::OwnedFd;
use std::process::Stdio;

use rustix::fs::{Mode, OFlags, open};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};

use super::help::commands;
use super::session::Session;

/// Octets that no command shows: they stand behind the last ones of each.
const END: &[u8] = b"\0end";

/// Everything that a command shows on a terminal of so many columns.
fn shown(session: &Session, arguments: &str, columns: u16) -> String {
    let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&ours).unwrap();
    unlockpt(&ours).unwrap();
    let size = Winsize { ws_row: 24, ws_col: columns, ws_xpixel: 0, ws_ypixel: 0 };
    tcsetwinsize(&ours, size).unwrap();
    let name = ptsname(&ours, Vec::new()).unwrap();
    let theirs = open(&name, OFlags::RDWR | OFlags::NOCTTY, Mode::empty()).unwrap();
    let stream = |end: &OwnedFd| Stdio::from(end.try_clone().unwrap());
    let mut command = session.command(arguments);
    command
        .stdout(stream(&theirs))
        .stderr(stream(&theirs))
        .env_remove("COLUMNS")
        .env("TERM", "xterm")
        .env("NO_COLOR", "1");
    let mut child = command.spawn().unwrap();
    drop(command);
    let reader = std::thread::spawn(move || {
        let (mut octets, mut part, mut ours) = (Vec::new(), [0; 4096], File::from(ours));
        while !octets.ends_with(END) {
            let length = ours.read(&mut part).unwrap();
            octets.extend_from_slice(&part[..length]);
        }
        octets.truncate(octets.len() - END.len());
        octets
    });
    child.wait().unwrap();
    // A terminal that hangs up may lose what it has not passed on, so our own end stays open until the reader has met the end.
    let mut theirs = File::from(theirs);
    theirs.write_all(END).unwrap();
    let octets = reader.join().unwrap();
    // A bar begins its line again and again.
    String::from_utf8_lossy(&octets).replace("\r\n", "\n").replace('\r', "\n")
}

/// The text without the sequences that style it or move the cursor.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        if character == '\u{1b}' && characters.next_if_eq(&'[').is_some() {
            while characters.next().is_some_and(|c| !c.is_ascii_alphabetic()) {}
        } else {
            out.push(character);
        }
    }
    out
}

/// Lines beyond the width.
fn beyond(text: &str, columns: u16) -> Vec<String> {
    plain(text).lines().filter(|line| line.chars().count() > usize::from(columns)).map(str::to_owned).collect()
}

#[test]
fn no_line_of_help_is_wider_than_the_terminal() {
    let session = Session::new();
    for columns in [80, 120] {
        for command in commands(&session, "") {
            for help in ["-h", "--help"] {
                let text = shown(&session, &format!("{command} {help}"), columns);
                assert!(text.contains("Usage:"), "{command}: {text}");
                assert_eq!(beyond(&text, columns), Vec::<String>::new(), "{command} {help} on {columns} columns");
            }
        }
    }
    // A wider terminal needs fewer lines, and short help fewer than all of it.
    let lines = |help: &str, columns| shown(&session, &format!("render {help}"), columns).lines().count();
    assert!(lines("--help", 120) < lines("--help", 80) && 2 * lines("-h", 80) < lines("--help", 80));
}

#[test]
fn no_line_of_tables_is_wider_than_the_terminal() {
    let session = Session::new();
    session.write("own.isa", ".extension own\n;; Half of a number.\n.instr half (d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [Done(body)]\n    srai d, a, 1\n.end\n");
    session.write("a.s", "    li s1, 7\n    set v2, -123456789, 987654321, -3\n    halt\n");
    session.succeed("scene generate cornell");
    for columns in [80, 120] {
        for arguments in [
            "render cornell --size 8x6",
            "render cornell --size 8x6 --full --flags",
            "render cornell --size 8x6 --pixel 1,1",
            "render cornell --size 8x6 --machine node_cache --cores 16 --full",
            "run a.s --flags --dump regs --dump 0:64",
            "cores cornell --size 8x6 --cores 1..4 --arbiter tdma --arbiter weighted",
            "cores annex --cores 4",
            "accuracy triangle --size 4x3",
            "profiles triangle --size 4x3",
            "skips triangle --size 4x3",
            "scene info cornell",
            "annex triangle --size 4x3",
            "annex --errata",
            "trace triangle --size 4x3 --pixel 1,1",
            "explain-pixel cornell 4,3 --size 8x6",
            "stress --list",
            "inject triangle --size 4x3 --injections 30",
            "explain",
            "explain E003",
            "schema",
            "bench triangle --size 4x3 --runs 1",
            "extension check own.isa",
            "extension compare own.isa --scene triangle --size 4x3",
            "extension suggest cornell --size 4x3",
        ] {
            let text = shown(&session, arguments, columns);
            // A message of one line would be narrow enough too, but it is no table.
            assert!(text.lines().count() > 1, "{arguments}: {text}");
            assert_eq!(beyond(&text, columns), Vec::<String>::new(), "{arguments} on {columns} columns");
        }
    }
}

#[test]
fn a_bar_shows_how_far_a_picture_is_and_vanishes() {
    let session = Session::new();
    let text = shown(&session, "render cornell --size 64x48 --no-error", 80);
    assert!(text.contains("pixels") && text.contains(" %"), "{text:?}");
    // Nothing is said on what is left before that is known.
    assert!(!text.contains("00:"), "{text:?}");
    assert_eq!(beyond(&text.replace('\u{1b}', "\n\u{1b}"), 80), Vec::<String>::new());
    let quiet = shown(&session, "render cornell --size 8x6 --no-error --message-format json -q", 80);
    assert_eq!(quiet, "");
}
