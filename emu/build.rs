//! Says whether the code is optimised enough that a call in the last place of a function becomes a jump: see `src/engine/fast/rows.rs`.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-check-cfg=cfg(threaded)");
    let level = std::env::var("OPT_LEVEL").unwrap_or_default();
    let target = std::env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    if (level == "2" || level == "3") && (target == "x86_64" || target == "aarch64") {
        println!("cargo:rustc-cfg=threaded");
    }
}
