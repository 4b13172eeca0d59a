//! An instruction whose meaning is in Rust, because assembly cannot say it: it has a table and makes noise. How many bits does the table
//! need? `cargo run --release --example reciprocal` prints what each size costs in picture quality.

mod study;

use lancer::failure::Failure;

fn main() -> Result<(), String> {
    let text = study::report().map_err(|failure| match failure {
        Failure::Message { report, .. } => report.render(false),
        Failure::ClosedPipe => "the pipe is closed".to_owned(),
    })?;
    print!("{text}");
    Ok(())
}
