//! `lancer` alone.

use super::session::Session;

#[test]
fn the_demo_writes_its_pictures_and_shows_everything() {
    let session = Session::new();
    let first = session.succeed("--size 16x12");
    for part in [
        "Racine Carr",
        "2,561",
        "cornell: 676 triangles, 16 x 12 pixels",
        "Operations by function",
        "Operations by class",
        "core 3",
        "bus: busy",
        "PSNR",
        "run hash",
        "Try next",
    ] {
        assert!(first.contains(part), "{part} is missing in\n{first}");
    }
    assert_eq!(first.matches("equal").count(), 3, "three annex rows");
    let widest = first.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(100), "a line has {widest:?} columns");
    for name in ["cornell", "cornell-heat", "cornell-error"] {
        assert!(session.read(&format!("out/{name}.png")).starts_with(b"\x89PNG"), "{name}");
    }
    assert_eq!(std::fs::read_dir(session.path("out")).unwrap().count(), 3);
    assert_eq!(session.succeed("--size 16x12"), first, "every run shows the same");
}

#[test]
fn a_file_in_the_place_of_the_folder_is_an_error() {
    let session = Session::new();
    session.write("out", "");
    session.fail("--size 16x12", 1, "the folder out for the demo's pictures cannot be made");
}
