//! `lancer annex --figure`: the report's figures of what is here.

use super::session::Session;

/// A figure as SVG.
fn drawn(session: &Session, arguments: &str) -> String {
    assert_eq!(session.succeed(&format!("annex {arguments} -o f.svg")), "");
    let svg = String::from_utf8(session.read("f.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{svg}");
    svg
}

#[test]
fn the_lowest_cost_is_where_the_tree_divides() {
    let session = Session::new();
    let svg = drawn(&session, "cornell --size 32x24 --figure 6");
    for words in ["cornell: cost of dividing the root along ", "lowest cost: the plane of 5.3.2", "not to divide"] {
        assert!(svg.contains(words), "{words}");
    }
}

#[test]
fn a_walk_has_every_ray_of_the_pixel() {
    let session = Session::new();
    let svg = drawn(&session, "slabs --size 32x24 --figure 7 --pixel 16,12");
    let explained = session.json("explain-pixel slabs 16,12 --size 32x24 --profile report");
    let followed: Vec<_> = explained["rays"].as_array().unwrap().iter().filter(|ray| !ray["step"].is_null()).collect();
    assert!(followed.len() > 3, "{}", followed.len());
    for ray in &followed {
        let name = format!("ray {} {}, level {}: ", ray["number"], ray["kind"].as_str().unwrap(), ray["level"]);
        assert!(svg.contains(&name), "{name}");
    }
    assert!(svg.contains(&format!("pixel 16,12: the walk through its {} rays", followed.len())));
    // Each ray but the first has a way down and one back.
    assert_eq!(svg.matches("stroke-dasharray").count(), followed.len() - 1);
}

#[test]
fn machines_are_drawn_as_their_files_describe_them() {
    let session = Session::new();
    session.write(
        "m.toml",
        "cores = 9\nbuffer_octets = 20000\n[bus]\noctets_per_beat = 16\n[cache]\nkind = \"nodes\"\noctets = 4096\n",
    );
    let svg = drawn(&session, "--figure 8");
    for words in ["4 cores on one bus", "18,525 octets", "1 octet in 2 clocks; arbiter round-robin", ">core 3<"] {
        assert!(svg.contains(words), "{words}");
    }
    let svg = drawn(&session, "--figure 8 --machine m.toml");
    for words in ["9 cores on one bus", "20,000 octets", "16 octets in 2 clocks", ">core 4<", ">.. core 8<"] {
        assert!(svg.contains(words), "{words}");
    }
    assert!(!svg.contains(">core 5<"));
    let svg = drawn(&session, "--figure 9 --machine m.toml");
    for words in ["mul: 1 clock", "4,096 octets for nodes", "waits for its transfers"] {
        assert!(svg.contains(words), "{words}");
    }
    session.succeed("annex --figure 9 -o f.pdf");
    assert!(session.read("f.pdf").starts_with(b"%PDF-"));
}

#[test]
fn figures_that_are_not_there_are_refused() {
    let session = Session::new();
    session.fail("annex --figure 5 -o f.svg", 2, "6..=9");
    session.fail("annex --figure 8", 2, "--output");
    session.fail("annex --figure 8 -o f.png", 2, ".svg or .pdf");
    session.fail("annex --figure 8 cornell -o f.svg", 2, "those of machines none");
    session.fail("annex --figure 7 slabs --size 8x6 --pixel 8,0 -o f.svg", 2, "no pixel 8,0");
    session.fail("annex --figure 6 slabs --pixel 1,1 -o f.svg", 2, "figure 7 alone");
    session.fail("annex --figure 6 slabs --machine report -o f.svg", 2, "figures 8 and 9 alone");
    session.fail("annex -o f.svg", 2, "--as-printed NAME or of --figure N");
    assert!(session.names().is_empty());
}
