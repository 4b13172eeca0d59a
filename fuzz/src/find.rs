//! Finds: an input on which something went wrong, in a file with all that leads to it again.

use std::path::{Path, PathBuf};

/// First line of a find's file.
const HEAD: &str = "lancer-fuzz find";

/// An input on which something went wrong.
pub struct Find {
    /// Name of the surface.
    pub target: String,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of the input among those of the seed, from 0.
    pub run: u64,
    /// Description of what went wrong.
    pub why: String,
    /// The input.
    pub input: Vec<u8>,
}

impl Find {
    /// Writes the find into a folder, under a name that says which it is.
    pub fn write(&self, folder: &Path) -> std::io::Result<PathBuf> {
        std::fs::create_dir_all(folder)?;
        let path = folder.join(format!("{}-{}-{}", self.target, self.seed, self.run));
        let why = self.why.replace('\n', "\n  ");
        let head = format!("{HEAD}\ntarget {}\nseed {}\nrun {}\nwhy\n  {why}\n\n", self.target, self.seed, self.run);
        std::fs::write(&path, [head.as_bytes(), &self.input].concat())?;
        Ok(path)
    }

    /// Reads a find that was written.
    pub fn read(path: &Path) -> Result<Find, String> {
        let octets = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let end = octets.windows(2).position(|pair| pair == b"\n\n").ok_or("the file has no head")?;
        let head = String::from_utf8_lossy(&octets[..end]).into_owned();
        if !head.starts_with(HEAD) {
            return Err(format!("{} is no find", path.display()));
        }
        let value =
            |key: &str| head.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(' ')).unwrap_or_default();
        let number = |key: &str| value(key).parse().map_err(|_| format!("`{key}` is no number"));
        let why = head.split_once("\nwhy\n").map(|(_, why)| why.trim().to_owned()).unwrap_or_default();
        Ok(Find {
            target: value("target").to_owned(),
            seed: number("seed")?,
            run: number("run")?,
            why,
            input: octets[end + 2..].to_vec(),
        })
    }
}
