//! `lancer servers`: one frame on several coprocessors.

use serde_json::Value;

use super::session::Session;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is a number"))
}

#[test]
fn one_server_is_the_machine_to_the_clock_and_all_divisions_draw_its_picture() {
    for (scene, options) in [
        ("cornell", "--size 24x18"),
        ("mirrors", "--size 20x15 --profile report --machine report"),
        ("terrain", "--size 24x18 --crop 5,3,17,11 --machine wide32 --cores 2"),
    ] {
        let session = Session::new();
        let alone = session.json(&format!("render {scene} {options}"));
        for home in ["copied", "shared"] {
            // Parts that do not show what the whole frame shows are an error, so this says that they do.
            let line = format!("servers {scene} {options} --servers 2,3,50 --tile 8x8 --tile 7x5 --scene-home {home}");
            let result = session.json(&line);
            assert_eq!(result["image_hash"], alone["image_hash"], "{line}");
            let curves = result["curves"].as_array().unwrap();
            let named = curves.iter().map(|curve| (curve["division"].as_str().unwrap(), curve["tile"][0].as_u64()));
            let all =
                [("tiles", Some(8)), ("tiles", Some(7)), ("rows", None), ("stealing", Some(8)), ("stealing", Some(7))];
            assert!(named.eq(all), "{line}");
            for curve in curves {
                let points = curve["points"].as_array().unwrap();
                assert_eq!(
                    points.iter().map(|point| point["servers"].as_u64().unwrap()).collect::<Vec<_>>(),
                    [1, 2, 3, 50]
                );
                let (one, clocks) = (&points[0], &alone["clocks"]);
                assert_eq!((&one["clocks"], &one["first_clocks"], &result["alone_clocks"]), (clocks, clocks, clocks));
                assert_eq!((&one["parts"], &one["port_octets"], &one["speed_up"]), (&1.into(), &0.into(), &1.0.into()));
                assert_eq!(one["bus_octets"], alone["bus"]["moved"]);
                for point in points {
                    let (least, mean) = (number(&point["least_busy"]), number(&point["mean_busy"]));
                    assert!(
                        0.0 <= least && least <= mean && mean <= 1.0 && number(&point["port_busy"]) <= 1.0,
                        "{point}"
                    );
                    let copies = number(&point["first_clocks"]) - number(&point["clocks"]);
                    let is_copied = home == "copied" && point["servers"] != 1;
                    assert!(if is_copied { copies > 0.0 } else { copies == 0.0 }, "{point}");
                    assert_eq!(point["shared_octets_per_clock"].is_null(), home == "copied" || point["servers"] == 1);
                }
            }
        }
    }
}

#[test]
fn pixels_requests_and_scenes_pass_the_port_and_nothing_else_does() {
    let session = Session::new();
    let of = |options: &str| session.json(&format!("servers cornell --size 24x18 {options}"));
    let tiles = of("--servers 2,100 --divide tiles --tile 8x6");
    let points = &tiles["curves"][0]["points"];
    // 9 tiles: a request of 16 octets each, and 12 octets a pixel.
    assert_eq!((&points[1]["parts"], &points[1]["port_octets"]), (&9.into(), &(9 * 16 + 24 * 18 * 12).into()));
    // Only servers that have a tile get a copy of the scene.
    let octets = tiles["scene_octets"].as_u64().unwrap();
    let (link, latency) = (tiles["link"]["octets_per_clock"].as_u64().unwrap(), 480);
    assert_eq!((link, tiles["link"]["latency_clocks"].as_u64().unwrap()), (2, latency));
    let first = points[2]["first_clocks"].as_u64().unwrap();
    assert!(first >= 9 * octets / link + 2 * latency, "nine copies of {octets} octets in {first} clocks");
    // Shared, a part is answered by a message, and its pixels are in the transfers.
    let shared = of("--servers 2 --divide tiles --tile 8x6 --scene-home shared");
    let point = &shared["curves"][0]["points"][1];
    assert_eq!(point["port_octets"], 9 * (16 + 16));
    let demanded = number(&point["bus_octets"]) / number(&point["clocks"]);
    assert!((number(&point["shared_octets_per_clock"]) - demanded).abs() < 1e-9);
}

#[test]
fn larger_latencies_and_narrower_links_take_longer() {
    let session = Session::new();
    let clocks = |options: &str| -> Vec<u64> {
        let line = format!("servers cornell --size 24x18 --servers 4 --divide stealing --tile 8x6 {options}");
        let result = session.json(&line);
        let point = &result["curves"][0]["points"][1];
        ["clocks", "first_clocks"].map(|key| point[key].as_u64().unwrap()).to_vec()
    };
    for home in ["copied", "shared"] {
        let near = clocks(&format!("--scene-home {home} --link-latency 0 --link-octets 64"));
        let far = clocks(&format!("--scene-home {home} --link-latency 1000 --link-octets 64"));
        let narrow = clocks(&format!("--scene-home {home} --link-latency 0 --link-octets 1"));
        assert!(near < far, "{home}: {near:?} {far:?}");
        assert!(near <= narrow && near[1] <= narrow[1], "{home}: {near:?} {narrow:?}");
    }
    // Two servers take more than half of the time of one, four more than a quarter.
    let result = session.json("servers cornell --size 24x18 --servers 2,4 --link-latency 0 --link-octets 65536");
    for point in result["curves"].as_array().unwrap().iter().flat_map(|curve| curve["points"].as_array().unwrap()) {
        assert!(number(&point["efficiency"]) <= 1.05, "{point}");
    }
}

#[test]
fn the_goal_of_table_3_is_told() {
    let session = Session::new();
    let result = session.json("servers cornell --size 24x18 --servers 4");
    let goal = &result["goal"];
    assert_eq!((number(&goal["pixel_seconds"]) * 1e9).round(), 13.0);
    let alone = number(&result["alone_pixel_seconds"]);
    assert_eq!(number(&goal["ideal_servers"]), (alone / 1.3e-8).ceil());
    // 12 octets a pixel over 2 a clock are 6 clocks of 100 MHz, 0.06 us: five times the goal.
    assert_eq!((&goal["servers"], &goal["limit"]), (&Value::Null, &"link".into()));
    let text = session.succeed("servers cornell --size 24x18 --servers 4");
    assert!(text.contains("0.01300 us a pixel: ") && text.contains("alone take the link longer"), "{text}");
    // On a wide link, a clock of 100 GHz makes up for a narrow bus, and more servers do the rest.
    let fast = "servers cornell --size 24x18 --tile 2x2 --divide stealing --link-octets 65536 --link-latency 0";
    let fast = format!("{fast} --set machine.clock_hz=100000000000");
    let result = session.json(&fast);
    let reached = result["goal"]["servers"].as_u64().unwrap();
    assert_eq!(result["goal"]["limit"], Value::Null);
    let result = session.json(&format!("{fast} --servers {},{reached}", reached - 1));
    let points = result["curves"][0]["points"].as_array().unwrap();
    let times: Vec<f64> = points.iter().map(|point| number(&point["pixel_seconds"])).collect();
    assert!(times[1] > 1.3e-8 && times[2] <= 1.3e-8, "{reached}: {times:?}");
}

#[test]
fn data_stand_beside_the_chart() {
    let session = Session::new();
    let text = session.succeed("servers cornell --size 24x18 --servers 2 --svg a.svg");
    assert_eq!(session.names(), ["a.csv", "a.svg"]);
    assert!(text.contains("\nbands of rows\n") && text.contains(" Intel "), "{text}");
    let csv = String::from_utf8(session.read("a.csv")).unwrap();
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..5], ["division", "tile_width", "tile_height", "servers", "parts"]);
    assert_eq!((rows.len(), rows[3][..4].to_vec()), (1 + 3 * 2, vec!["rows", "", "", "1"]));
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    let svg = String::from_utf8(session.read("a.svg")).unwrap();
    assert!(svg.contains("speed-up by servers") && svg.contains("stealing"), "{svg}");
}

#[test]
fn frames_that_cannot_be_divided_are_refused() {
    let session = Session::new();
    session.fail("servers cornell --size 24x18 --interpolate=0.1", 2, "is not divided");
    session.fail("servers cornell --size 1024x768 --tile 1x1", 2, "parts, and at most 16384");
    session.fail("servers cornell --size 1024x768 --divide rows --servers 1..256", 2, "parts, and at most 16384");
    session.fail("servers cornell --size 8x6 --servers 1..300", 2, "300 numbers of servers");
    // Tiles that nobody asks for do not count.
    session.succeed("servers triangle --size 160x120 --tile 1x1 --divide rows --servers 2");
    session.fail("servers cornell --servers 0", 2, "number of servers");
    session.fail("servers cornell --link-octets 0", 2, "--link-octets");
    session.fail("servers cornell --scene-home shared --arbiter tdma --link-latency 100000 --size 8x6", 1, "slot");
}
