//! Lets the linker keep one copy of functions whose code is the same, which makes the program a sixteenth smaller.

use std::path::Path;
use std::process::Command;

/// True where the program is linked by the linker that comes with the compiler and knows the option: it lies in the compiler's folder, and nobody has chosen
/// another one or flags of their own.
fn links_with_lld() -> bool {
    const TARGET: &str = "x86_64-unknown-linux-gnu";
    let is_chosen = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if is_chosen("RUSTC_LINKER") || is_chosen("CARGO_ENCODED_RUSTFLAGS") || !is("TARGET", TARGET) {
        return false;
    }
    let folder = || {
        let asked = Command::new(std::env::var_os("RUSTC")?).args(["--print", "sysroot"]).output().ok()?;
        String::from_utf8(asked.stdout).ok()
    };
    let linker = |folder: String| Path::new(folder.trim()).join("lib/rustlib").join(TARGET).join("bin/gcc-ld/ld.lld");
    folder().is_some_and(|folder| linker(folder).exists())
}

/// True where Cargo says so of this build.
fn is(name: &str, value: &str) -> bool {
    std::env::var(name).is_ok_and(|said| said == value)
}

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // A profiler wants each function under its own name.
    if is("PROFILE", "release") && is("DEBUG", "false") && links_with_lld() {
        println!("cargo::rustc-link-arg-bins=-Wl,--icf=all");
    }
}
