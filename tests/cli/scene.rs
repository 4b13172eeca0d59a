//! `lancer scene`: scenes as files and as figures.

use super::session::Session;

#[test]
fn a_generated_scene_is_the_same_from_its_files() {
    let session = Session::new();
    let text = session.succeed("scene generate cornell --level 2 --size 8x6");
    assert!(text.starts_with("cornell.dsc and cornell.off: "), "{text}");
    assert_eq!(session.names(), ["cornell.dsc", "cornell.off"]);
    let files = (session.read("cornell.dsc"), session.read("cornell.off"));
    session.succeed("scene generate cornell --level 2 --size 8x6");
    assert_eq!(files, (session.read("cornell.dsc"), session.read("cornell.off")));
    let result = session.json("render cornell.dsc --shift 0.137,0.071");
    assert_eq!((&result["width"], &result["scene"]), (&8.into(), &"cornell".into()));
    std::fs::rename(session.path("cornell.off"), session.path("room.off")).unwrap();
    let other = session.json("render cornell.dsc --mesh room.off --shift 0.137,0.071");
    assert_eq!(other["run_hash"], result["run_hash"]);
    session.fail("render cornell.dsc", 1, "cornell.off is not there");
}

#[test]
fn a_mesh_alone_renders() {
    let session = Session::new();
    session.write("t.off", "OFF\n3 1 0\n-1 -1 0\n1 -1 0\n0 1 0\n3 0 1 2\n");
    let result = session.json("render t.off --size 8x8 --shift 0.137,0.071");
    assert_eq!((&result["triangles"], &result["scene"], &result["width"]), (&1.into(), &"t".into(), &8.into()));
    assert!(result["rays"]["shadow"].as_u64() > Some(0));
}

#[test]
fn errors_in_scene_files_show_their_place() {
    let session = Session::new();
    session.write("t.off", "OFF\n3 1 0\n-1 -1 0\n1 -1 0\n0 nan 0\n3 0 1 7\n");
    session.fail("render t.off -o a.png", 1, "t.off:5:3");
    session.fail("scene info t.off", 1, "t.off:5:3");
    session.write("big.off", "OFF\n1000000000 1000000000 0\n0 0 0\n");
    session.fail("scene info big.off", 1, "big.off:");
    assert_eq!(session.names(), ["big.off", "t.off"]);
    session.fail("render triangle --size 5000x5000", 1, "has more than 16,777,216");
}

#[test]
fn facts_of_a_scene_have_their_types() {
    let session = Session::new();
    let facts = session.json("scene info cornell");
    for key in ["triangles", "vertices", "unused_vertices", "lights", "width", "height"] {
        assert!(facts[key].is_u64(), "{key}");
    }
    assert!(facts["schema"].is_string() && facts["bounds"][1][2].is_f64() && facts["has_glass"] == true);
    assert!(facts["tree"]["leaves"].is_u64() && facts["memory"]["octets"]["nodes"].is_u64());
    assert!(facts["precision"]["largest_move"].is_f64() && facts["formats"]["dir"].is_i64());
    assert_eq!(facts["materials"].as_array().unwrap().len(), 7);
    let report = session.json("scene info cornell --layout report --word 24 --kd-depth 3");
    assert_eq!((&report["memory"]["layout"], &report["formats"]["word"]), (&"report".into(), &24.into()));
    assert_eq!(report["tree"]["depth"], 3);
    let text = session.succeed("scene info cornell");
    assert!(text.contains("676 triangles") && text.contains("kd tree: 1,385 nodes"), "{text}");
    // The formats are those of a picture with the same camera, whatever the word, and of a study of its accuracy.
    for (scene, word, camera) in [
        ("cornell", 20, ""),
        ("sphereflake", 32, ""),
        ("sphereflake", 24, "--camera perspective"),
        ("cornell", 32, "--camera perspective"),
        ("cornell", 24, "--eye 900,3,-20 --look 0,0,0 --fov 1"),
    ] {
        let info = session.json(&format!("scene info {scene} --size 4x3 --word {word} {camera}"));
        let picture = session.json(&format!("render {scene} --size 4x3 --no-error --word {word} {camera}"));
        assert_eq!(info["formats"], picture["formats"], "{scene} {word} {camera}");
        let study = session.json(&format!(
            "accuracy {scene} --size 4x3 --words {word} --profiles vector --roundings RND --layouts wide --bounces 5 --cutoffs 0 --interpolate none {camera}"
        ));
        let variants = study["variants"].as_array().expect("a list");
        assert!(
            !variants.is_empty() && variants.iter().all(|variant| variant["formats"] == info["formats"]),
            "{study}"
        );
    }
    assert!(session.json("scene info empty")["bounds"].is_null());
}

#[test]
fn options_that_a_scene_does_not_have_are_refused() {
    let session = Session::new();
    session.fail("scene generate terrain --level 3", 1, "no option `level`");
    session.fail("scene generate cornell --level 0", 1, "1 to 500");
    session.succeed("scene generate terrain --triangles 37");
    assert_eq!(session.json("scene info terrain.dsc")["triangles"], 37);
}
