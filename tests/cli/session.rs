//! A folder of its own in which a test runs commands.

use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// A fresh folder; it vanishes with its files.
pub struct Session {
    folder: TempDir,
}

/// Outcome of a command.
pub struct Run {
    /// Exit code.
    pub code: i32,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub messages: String,
}

impl Session {
    /// An empty folder.
    pub fn new() -> Session {
        Session { folder: tempfile::tempdir().unwrap() }
    }

    /// A path in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file.
    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// The octets of a file.
    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Names of all files, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The command `lancer` with arguments between blanks, ready to be started here.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lancer"));
        command.args(arguments.split_whitespace()).current_dir(self.folder.path()).stdin(Stdio::null());
        command
    }

    /// A page as a browser shows it after a script; `None` where no browser is installed.
    pub fn browse(&self, page: &str, script: &str) -> Option<String> {
        self.write("shown.html", &page.replace("</body>", &format!("<script>{script}</script></body>")));
        let mut browser = Command::new("chromium");
        browser.args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", "--virtual-time-budget=5000"]);
        browser.arg(format!("--user-data-dir={}", self.path("profile").display()));
        let output = browser.arg(self.path("shown.html")).output().ok()?;
        Some(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    /// Runs `lancer` with arguments between blanks.
    pub fn run(&self, arguments: &str) -> Run {
        let Output { status, stdout, stderr } = self.command(arguments).output().unwrap();
        let text = |octets: Vec<u8>| String::from_utf8(octets).expect("results and messages are text");
        Run { code: status.code().expect("no signal ended it"), out: text(stdout), messages: text(stderr) }
    }

    /// Runs a command that has to succeed without a message, and gives its results.
    pub fn succeed(&self, arguments: &str) -> String {
        let run = self.run(arguments);
        assert_eq!((run.code, run.messages.as_str()), (0, ""), "lancer {arguments}");
        run.out
    }

    /// Runs a command with `--json` that has to succeed.
    pub fn json(&self, arguments: &str) -> Value {
        serde_json::from_str(&self.succeed(&format!("{arguments} --json"))).expect("--json prints JSON")
    }

    /// Runs a command that has to fail with a code, with no result and with a message that contains a text.
    #[track_caller]
    pub fn fail(&self, arguments: &str, code: i32, message: &str) {
        let run = self.run(arguments);
        assert_eq!((run.code, run.out.as_str()), (code, ""), "lancer {arguments}\n{}", run.messages);
        assert!(run.messages.contains(message), "lancer {arguments}\n{}", run.messages);
    }
}

/// The data of a page.
pub fn page_data(page: &str) -> Value {
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").expect("the page has data");
    serde_json::from_str(rest.split_once("</script>").expect("the data end").0).expect("the data are JSON")
}
