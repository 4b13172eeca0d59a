//! Savings of the vector rows on the report's kernels, and of the ray unit on those: docs/profiles.md says it, and it is measured again.

use std::process::Command;

use serde_json::Value;

fn lancer(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_lancer")).args(arguments).output().expect("lancer starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("results are text")
}

/// The largest of a ratio over the scenes, and its mean.
fn most_and_mean(ratios: &[Value], profile: &str, key: &str) -> (f64, f64) {
    let own: Vec<&Value> = ratios.iter().filter(|ratio| ratio["profile"] == profile).collect();
    let (mean, scenes): (Vec<&Value>, Vec<&Value>) = own.iter().partition(|ratio| ratio["scene"].is_null());
    assert_eq!((mean.len(), scenes.len()), (1, 5));
    let figure = |ratio: &Value| ratio[key].as_f64().unwrap();
    (scenes.iter().map(|ratio| figure(ratio)).fold(0.0, f64::max), figure(mean[0]))
}

#[test]
fn profiles_save_what_their_document_says() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/profiles.md");
    let document = std::fs::read_to_string(path).unwrap();
    let (before, after) = document.split_once("```text\n").unwrap();
    let (shown, after) = after.split_once("```\n").unwrap();
    let text = lancer(&["profiles", "--size", "32x24"]);
    if std::env::var_os("LANCER_BLESS").is_some() {
        std::fs::write(path, format!("{before}```text\n{text}```\n{after}")).unwrap();
    } else {
        assert_eq!(shown, text, "LANCER_BLESS=1 writes it as it is now");
    }
    let json: Value = serde_json::from_str(&lancer(&["profiles", "--size", "16x12", "--json"])).unwrap();
    let ratios = json["ratios"].as_array().unwrap();
    // Limits for one scene and for the mean of the five.
    let limits = [
        ("vector", "operations", 0.85, 0.75),
        ("vector", "octets", 0.75, 0.5),
        ("ray", "instructions", 0.5, 0.5),
        ("ray", "search_instructions", 0.3, 0.3),
        ("packet", "instructions", 0.6, 0.5),
        ("packet", "search_instructions", 0.5, 0.4),
        ("packet", "operations", 1.6, 1.5),
        ("packet", "octets", 1.6, 1.1),
    ];
    for (profile, key, each, together) in limits {
        let (most, mean) = most_and_mean(ratios, profile, key);
        assert!(most <= each && mean <= together, "{key} of {profile}: {most} at most, {mean} in the mean");
    }
    let pictures = json["pictures"].as_array().unwrap();
    let hash = |scene: &str, profile: &str| {
        let is_it = |picture: &&Value| picture["scene"] == scene && picture["profile"] == profile;
        pictures.iter().find(is_it).unwrap()["image_hash"].clone()
    };
    assert_eq!(hash("slabs", "vector"), hash("slabs", "ray"), "both decide exactly");
    let transfers = |scene: &str, profile: &str| {
        let is_it = |picture: &&Value| picture["scene"] == scene && picture["profile"] == profile;
        pictures.iter().find(is_it).unwrap()["counts"]["mem"].as_f64().unwrap()
    };
    for scene in ["cornell", "sphereflake", "slabs", "mirrors", "terrain"] {
        assert_eq!(hash(scene, "ray"), hash(scene, "packet"), "{scene}: the same decisions and roundings");
        let ratio = transfers(scene, "packet") / transfers(scene, "ray");
        assert!((0.05..0.3).contains(&ratio), "{scene}: {ratio} times the transfers");
    }
}

/// The page on the report's buffer: its listings are what the commands print, and its sums the octets of the programs.
#[test]
fn buffers_take_what_their_document_says() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/buffer.md");
    let document = std::fs::read_to_string(path).unwrap();
    let mut parts = document.split("```console\n$ lancer ");
    let mut text = parts.next().unwrap().to_owned();
    let mut listings = 0;
    for part in parts {
        let (listing, after) = part.split_once("```\n").unwrap();
        let command = listing.lines().next().unwrap();
        let output = lancer(&command.split(' ').collect::<Vec<_>>());
        text += &format!("```console\n$ lancer {command}\n{output}```\n{after}");
        listings += 1;
    }
    assert_eq!(listings, 4);
    if std::env::var_os("LANCER_BLESS").is_some() {
        std::fs::write(path, &text).unwrap();
    } else {
        assert_eq!(document, text, "LANCER_BLESS=1 writes it as it is now");
    }
    let sets = "report,buffered,prefetched";
    let scenes = ["cornell", "slabs"];
    let json: Value = serde_json::from_str(&lancer(
        &[&["profiles", "--size", "8x6", "--profiles", sets, "--json"], &scenes[..]].concat(),
    ))
    .unwrap();
    let pictures = json["pictures"].as_array().unwrap();
    let picture = |scene: &str, profile: &str| {
        let is_it = |picture: &&Value| picture["scene"] == scene && picture["profile"] == profile;
        pictures.iter().find(is_it).unwrap()
    };
    for scene in scenes {
        let hash = |profile: &str| picture(scene, profile)["image_hash"].clone();
        assert!(hash("report") == hash("buffered") && hash("report") == hash("prefetched"), "{scene}");
        // Nodes, triangles, the nearest one, rays, what the page adds, and the materials and lights, of 32 and 24 octets.
        let tables = picture(scene, "buffered")["buffer_octets"].as_u64().unwrap() - (110 + 15_872 + 31 + 572 + 591);
        assert!(tables <= 768 && tables % 8 == 0 && tables > 0, "{scene}: {tables}");
    }
}
