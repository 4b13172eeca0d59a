//! The package for Python, run by Python where it has what the package needs.

use std::path::Path;
use std::process::Command;

/// Names another Python than `python3`.
const PYTHON: &str = "LANCER_PYTHON";

#[test]
fn the_package_for_python_gives_tables_and_pictures() {
    let python = std::env::var(PYTHON).unwrap_or_else(|_| "python3".to_owned());
    let has = Command::new(&python).args(["-c", "import numpy, pandas"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: `{python}` has no numpy and pandas; {PYTHON} names another one");
        return;
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("python");
    let tests = Command::new(&python)
        .args(["-B", "-m", "unittest", "discover", "-s", "tests"])
        .current_dir(&folder)
        .env("PYTHONPATH", &folder)
        .env("LANCER", env!("CARGO_BIN_EXE_lancer"))
        .output()
        .unwrap();
    assert!(tests.status.success(), "{}", String::from_utf8_lossy(&tests.stderr));
}
