//! Runs that are killed while they write and rename their files. After a kill each file is the old one or the new one; after the next run in the folder,
//! whatever it does, the files of a set are all old or all new, and nothing else is left.
//!
//! A few kills come at some time of the second half of a run. With `LANCER_RUNS`, and where `strace` is installed, they come before each system call
//! that makes, writes, renames or removes a file, so that no moment between two of them is left out.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::{command, runs, succeed};

/// A command that writes files. In its words, `{}` is 24 for the files that are there before, and 32 for those that take their places.
struct WritingCommand {
    words: &'static str,
    /// Folder of its files.
    folder: &'static str,
    /// Files that are there all together or not at all, else each by itself.
    is_set: bool,
}

const SET: WritingCommand = WritingCommand { words: "", folder: ".", is_set: true };

/// Commands that write sets of files, single ones, and files of hours.
const COMMANDS: [WritingCommand; 11] = [
    WritingCommand { words: "render triangle --size 8x6 --word {} -o a.png --error e.png --heat h.png", ..SET },
    WritingCommand { words: "scene generate cornell --size {}x6 -o scene", folder: "scene", ..SET },
    WritingCommand { words: "scene convert ../{}/terrain.dsc b.obj", ..SET },
    WritingCommand { words: "accuracy triangle --size 4x3 --words {} --profiles ray --svg a.svg --pdf a.pdf", ..SET },
    WritingCommand { words: "cores triangle --size 4x3 --cores 1,2 --word {} --svg c.svg", ..SET },
    WritingCommand { words: "servers triangle --size 4x3 --servers 1,2 --word {} --svg s.svg", ..SET },
    WritingCommand { words: "trace triangle --size 4x3 --pixel 1,1 --word {}", ..SET },
    WritingCommand { words: "assemble ../{}.s -o p.o", ..SET },
    WritingCommand { words: "sweep plan ../{}.toml -o plan.jsonl", ..SET },
    WritingCommand { words: "sweep run ../{}.jsonl --out parts", folder: "parts", is_set: false },
    WritingCommand { words: "stress --case colours --resume state.json", folder: ".", is_set: false },
];

/// Kills of each command where no number is asked for.
const FEW: usize = 2;

/// System calls by which files come, grow, change their names and go.
const CALLS: &str = "openat,write,fchmod,flock,fsync,rename,renameat,renameat2,link,linkat,unlink,unlinkat";

/// First part of the names of files that are being written.
const BEING_WRITTEN: &str = ".lancer-";

type FolderContents = BTreeMap<String, Vec<u8>>;

fn contents(folder: &Path) -> FolderContents {
    let Ok(entries) = fs::read_dir(folder) else { return FolderContents::new() };
    let paths = entries.map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    // A file that is being written may be gone.
    paths.filter_map(|path| Some((path.file_name()?.to_str()?.to_owned(), fs::read(&path).ok()?))).collect()
}

/// A place for one command: a folder with what is read, and one below it in which the command runs.
struct KillBench {
    root: tempfile::TempDir,
    tried: &'static WritingCommand,
    old: FolderContents,
    new: FolderContents,
    /// Time of a run that is left alone.
    time: Duration,
}

impl KillBench {
    fn new(tried: &'static WritingCommand) -> KillBench {
        let root = tempfile::tempdir().unwrap();
        for number in ["24", "32"] {
            fs::write(root.path().join(format!("{number}.s")), format!("movi s1, {number}\nhalt\n")).unwrap();
            let study = format!(
                "name = \"kills\"\n[settings]\nscene = \"triangle\"\nview.size = [4, 3]\n[product]\nword = [{number}, 20, 16]\n"
            );
            fs::write(root.path().join(format!("{number}.toml")), study).unwrap();
            succeed(&format!("scene generate terrain --triangles {number} -o {number}"), root.path());
            succeed(&format!("sweep plan {number}.toml -o {number}.jsonl"), root.path());
        }
        let (old, new) = (FolderContents::new(), FolderContents::new());
        let mut bench = KillBench { root, tried, old, new, time: Duration::ZERO };
        let files = |number| {
            bench.reset(&FolderContents::new());
            succeed(&bench.words(number), &bench.place());
            contents(&bench.folder())
        };
        let old = files("24");
        let start = Instant::now();
        let new = files("32");
        bench.time = start.elapsed();
        (bench.old, bench.new) = (old, new);
        bench
    }

    fn words(&self, number: &str) -> String {
        self.tried.words.replace("{}", number)
    }

    /// Folder in which the command runs.
    fn place(&self) -> PathBuf {
        self.root.path().join("here")
    }

    fn folder(&self) -> PathBuf {
        self.place().join(self.tried.folder)
    }

    /// Empties the folder, but for files that are there before.
    fn reset(&self, before: &FolderContents) {
        let _ = fs::remove_dir_all(self.place());
        fs::create_dir(self.place()).unwrap();
        fs::create_dir_all(self.folder()).unwrap();
        before.iter().for_each(|(name, octets)| fs::write(self.folder().join(name), octets).unwrap());
    }

    /// Tries one kill; true where the run did not end by itself.
    fn kill(&self, has_old: bool, kill: impl Fn(&KillBench) -> bool) -> bool {
        let nothing = FolderContents::new();
        // What a study has made already is not made again, so it begins with nothing.
        let before = if has_old && self.tried.is_set { &self.old } else { &nothing };
        self.reset(before);
        let is_killed = kill(self);
        let after = contents(&self.folder());
        let what = self.words("32");
        for (name, octets) in after.iter().filter(|(name, _)| !name.starts_with(BEING_WRITTEN)) {
            let is_whole =
                [before.get(name), self.new.get(name)].contains(&Some(octets)) || self.is_state(name, octets);
            assert!(is_whole, "{what}: {name} is neither old nor new after a kill");
        }
        if self.tried.is_set {
            // The next run in the folder may be another command.
            succeed(&format!("assemble {}/24.s -o next.o", self.root.path().display()), &self.folder());
            let mut after = contents(&self.folder());
            after.remove("next.o");
            assert!(after == *before || after == self.new, "{what}: after the next run there are {:?}", after.keys());
        }
        // The same command again makes all of it.
        succeed(&what, &self.place());
        let mut after = contents(&self.folder());
        after.remove("next.o");
        assert!(after == self.new, "{what}: after the same run there are {:?}", after.keys());
        is_killed
    }

    /// True of a state of a run of hours, which is any whole JSON.
    fn is_state(&self, name: &str, octets: &[u8]) -> bool {
        !self.tried.is_set && name == "state.json" && serde_json::from_slice::<serde_json::Value>(octets).is_ok()
    }

    fn start(&self, mut command: Command) -> Child {
        command.spawn().unwrap_or_else(|error| panic!("{command:?}: {error}"))
    }

    /// Kills a run some time after its start.
    fn kill_after(&self, delay: Duration) -> bool {
        let mut child = self.start(command(env!("CARGO_BIN_EXE_lancer"), &self.words("32"), &self.place()));
        std::thread::sleep(delay);
        let _ = child.kill();
        child.wait().unwrap().code().is_none()
    }

    /// The system calls of a run from its first file on, each with its number among those of its name.
    fn calls(&self) -> Vec<(String, usize)> {
        let nothing = FolderContents::new();
        self.reset(if self.tried.is_set { &self.old } else { &nothing });
        let log = self.root.path().join("calls");
        let traced = format!(
            "-f -qq -o {} -e trace={CALLS} {} {}",
            log.display(),
            env!("CARGO_BIN_EXE_lancer"),
            self.words("32")
        );
        self.start(command("strace", &traced, &self.place())).wait().unwrap();
        let text = fs::read_to_string(log).unwrap();
        let thread = text.split(' ').next().unwrap_or_default();
        let (mut counts, mut calls) = (BTreeMap::<String, usize>::new(), Vec::new());
        // Lines are `217   rename("a", "b") = 0`; files are written by the first thread alone.
        for line in text.lines().filter_map(|line| line.strip_prefix(thread)) {
            let Some((name, rest)) = line.trim_start().split_once('(') else { continue };
            let number = counts.entry(name.to_owned()).or_default();
            *number += 1;
            if rest.contains(BEING_WRITTEN) || !calls.is_empty() {
                calls.push((name.to_owned(), *number));
            }
        }
        calls
    }

    /// Kills a run before a system call.
    fn kill_before(&self, (name, number): &(String, usize)) -> bool {
        let traced = format!(
            "-f -qq -o /dev/null -e trace={name} -e inject={name}:signal=SIGKILL:when={number} {} {}",
            env!("CARGO_BIN_EXE_lancer"),
            self.words("32")
        );
        let status = self.start(command("strace", &traced, &self.place())).wait().unwrap();
        !status.success()
    }
}

fn has_strace() -> bool {
    Command::new("strace").arg("-V").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
}

#[test]
fn a_killed_run_leaves_no_part_of_a_file_and_no_part_of_a_set() {
    let all = runs();
    let mut total = 0;
    for tried in &COMMANDS {
        let bench = KillBench::new(tried);
        assert!(!bench.new.is_empty(), "{}: it writes no file in {}", tried.words, tried.folder);
        let mut killed = 0;
        match all {
            Some(all) if has_strace() => {
                let calls = bench.calls();
                assert!(!calls.is_empty(), "{}: strace shows no call", tried.words);
                let kills = all.div_ceil(COMMANDS.len());
                // Over all calls and back to the first, over files that are there before and over an empty folder.
                for number in 0..kills {
                    let at = if kills < calls.len() { number * calls.len() / kills } else { number % calls.len() };
                    killed += usize::from(
                        bench.kill(number % 2 == (number / calls.len()) % 2, |bench| bench.kill_before(&calls[at])),
                    );
                }
                println!("{killed:>5} kills before {:>3} system calls: {}", calls.len(), tried.words);
            }
            _ => {
                let kills = all.map_or(FEW, |all| all.div_ceil(COMMANDS.len()));
                for number in 0..kills {
                    let delay = bench.time.mul_f64(0.5 + 0.6 * number as f64 / kills as f64);
                    killed += usize::from(bench.kill(number % 2 == 0, |bench| bench.kill_after(delay)));
                }
                println!("{killed:>5} kills: {}", tried.words);
            }
        }
        total += killed;
    }
    println!("{total:>5} kills: no part of a file, no part of a set after the next run, nothing left");
    assert!(total > 0, "no run was killed");
}
