//! `lancer scene convert`: what is written, what is said to be lost, and what stays as it was.

use super::session::Session;

/// Two triangles in two materials, one of them a mirror; a light of its own.
const DESCRIPTION: &str = "DSC\n8 6\n2 1\n1 0.5 0 0 0.9 0\n0 0 1 0.5 0.5 0\n1 2 3 1 1 1\n2\n0 1\n";
const MESH: &str = "OFF\n4 2 0\n-1 -1 0\n1 -1 0.1\n1 1 0\n-1 1 0\n3 0 1 2\n3 0 2 3\n";

fn session() -> Session {
    let session = Session::new();
    session.write("house.dsc", DESCRIPTION);
    session.write("house.off", MESH);
    session
}

/// Hash of a small picture of a scene.
fn hash(session: &Session, scene: &str) -> String {
    let result = session.json(&format!("render {scene} --size 8x6 --shift 0.137,0.071 --no-error"));
    result["run_hash"].as_str().unwrap().to_owned()
}

#[test]
fn a_description_keeps_everything_in_every_format() {
    let session = session();
    let wanted = hash(&session, "house.dsc");
    for (output, files) in [
        ("a.obj --dsc", "a.dsc and a.obj and a.mtl"),
        ("b.ply --dsc", "b.dsc and b.ply"),
        ("c.off --dsc", "c.dsc and c.off"),
        ("d.dsc", "d.dsc and d.off"),
    ] {
        let said = session.succeed(&format!("scene convert house.dsc {output}"));
        assert_eq!(said, format!("{files}: 2 triangles, 2 materials, 1 light\n"));
        let scene = files.split_whitespace().next().unwrap();
        assert_eq!(hash(&session, scene), wanted, "{scene}");
    }
    let run = session.run("scene convert house.dsc e.stl --dsc");
    assert_eq!(
        (run.code, run.messages.trim()),
        (0, "warning: an .stl file does not hold digits beyond single precision")
    );
}

#[test]
fn what_a_mesh_alone_loses_is_said() {
    let session = session();
    for (output, lost) in [
        ("a.off", "an .off file does not hold the size of the picture, the lights and mirrors and glass"),
        ("b.obj", "an .obj file does not hold the size of the picture, the lights and the share of ambient light"),
        ("c.ply", "a .ply file does not hold the size of the picture, the lights, mirrors and glass and digits of"),
        ("d.stl", "an .stl file does not hold the size of the picture, the lights, the materials and digits beyond"),
    ] {
        let run = session.run(&format!("scene convert house.dsc {output}"));
        assert!(run.code == 0 && run.messages.contains(lost), "{output}: {}", run.messages);
        assert_eq!(session.json(&format!("scene info {output}"))["triangles"], 2);
    }
    // The colours are there, the mirror is not; between .off and .obj only what light does in the dark is different.
    let materials = session.json("scene info a.off")["materials"].clone();
    assert_eq!(
        (&materials[0]["colour"], &materials[1]["reflection"]),
        (&serde_json::json!([1.0, 0.5, 0.0]), &0.0.into())
    );
    assert_eq!(session.json("scene info b.obj")["materials"][1]["reflection"], 0.5);
    // A mesh alone has nothing that the next one could not hold.
    for (from, to) in
        [("a.off", "e.off"), ("a.off", "e.dsc"), ("b.obj", "f.obj"), ("c.ply", "e.ply"), ("d.stl", "e.stl")]
    {
        session.succeed(&format!("scene convert {from} {to}"));
        assert_eq!(hash(&session, from), hash(&session, to), "{from} {to}");
    }
}

#[test]
fn a_generated_scene_and_a_name_without_extension() {
    let session = Session::new();
    session.run("scene convert cornell room --to PLY");
    assert!(session.read("room").starts_with(b"ply\n"));
    assert_eq!(session.json("scene info room")["triangles"], 676);
    session.run("scene convert cornell room.txt --to obj");
    assert_eq!(session.names(), ["room", "room.mtl", "room.txt"]);
    session.fail("scene convert cornel a.off", 1, "did you mean `cornell`?");
}

#[test]
fn nothing_that_is_read_is_overwritten() {
    let session = session();
    session.write("other.off", MESH);
    session.write("lib.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    session.write("a.mtl", "newmtl m\nKd 1 0 0\n");
    std::fs::create_dir(session.path("sub")).unwrap();
    let before = session.names();
    for (arguments, name) in [
        ("house.off house.off", "house.off"),
        ("house.off ./house.off", "./house.off"),
        ("house.off sub/../house.off", "sub/../house.off"),
        ("house.off house.dsc", "house.off"),
        ("house.dsc house.dsc", "house.off"),
        ("house.dsc house.off", "house.off"),
        ("house.dsc other.dsc --mesh other.off", "other.off"),
        ("lib.obj a.obj", "a.mtl"),
        ("house.dsc house.ply --dsc", "house.dsc"),
    ] {
        session.fail(&format!("scene convert {arguments}"), 2, &format!("{name} is read, and would be overwritten"));
    }
    assert_eq!((session.names(), session.read("house.off")), (before, MESH.as_bytes().to_vec()));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(session.path("house.off"), session.path("link.off")).unwrap();
        session.fail("scene convert house.off link.off", 2, "would be overwritten");
        assert_eq!(session.read("house.off"), MESH.as_bytes());
    }
}

#[test]
fn all_files_or_none() {
    let session = session();
    session.write("huge.off", "OFF\n3 1 0\n0 0 0\n1e300 0 0\n0 1 0\n3 0 1 2\n");
    session.write("bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    std::fs::create_dir(session.path("taken.mtl")).unwrap();
    let before = session.names();
    session.fail("scene convert huge.off a.stl --dsc", 1, "not a finite number in single precision");
    session.fail("scene convert bad.off a.obj", 1, "bad.off:6:7");
    session.fail("scene convert house.off taken.obj", 1, "taken.mtl is a folder");
    session.fail("scene convert house.off no/such/a.obj", 1, "mkdir -p no/such");
    session.fail("scene convert house.off a#b.obj", 1, "an .obj cannot name a#b.mtl");
    assert_eq!(session.names(), before);
}
