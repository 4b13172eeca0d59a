//! `lancer report`: one page that needs nothing else, as a browser shows it.

use serde_json::Value;

use super::session::{Session, page_data};

const TINY: &str = "cornell --size 12x9 --shift 0.137,0.071";

#[test]
fn the_page_has_what_the_other_commands_say() {
    let session = Session::new();
    assert_eq!(session.succeed(&format!("report {TINY} --no-advice -o r.html")), "");
    let page = String::from_utf8(session.read("r.html")).unwrap();
    let data = page_data(&page);
    let render = session.json(&format!("render {TINY}"));
    for key in ["clocks", "image_hash", "run_hash", "functions"] {
        assert_eq!(data["render"][key], render[key], "{key}");
    }
    // Lines have the operations of the cores, and the bus over time its busy clocks.
    let sum = |list: &Value, of: &dyn Fn(&Value) -> u64| list.as_array().unwrap().iter().map(of).sum::<u64>();
    let elementary = ["add", "sub", "mul", "div", "cmp"].map(|class| render["counts"][class].as_u64().unwrap());
    assert_eq!(sum(&data["lines"], &|line| line["operations"].as_u64().unwrap()), elementary.iter().sum::<u64>());
    let busy = sum(&data["course"]["busy"], &|part| part[0].as_u64().unwrap() + part[1].as_u64().unwrap());
    assert_eq!(busy, render["bus"]["busy"]);
    assert_eq!(
        (&data["advice"], data["annexes"]["rows"].as_array().unwrap().len()),
        (&Value::Null, kernels::annex::rows().len())
    );
    assert_eq!(data["render"]["settings"]["machine"]["bus"]["octets_per_beat"], 1);
    assert_eq!(session.names(), ["r.html"]);
    session.fail(&format!("report {TINY} -o no/r.html"), 1, "there is no folder no");
}

#[test]
fn the_page_shows_values_under_the_cursor_and_sorts() {
    let session = Session::new();
    session.succeed(&format!("report {TINY} -o r.html"));
    let page = String::from_utf8(session.read("r.html")).unwrap();
    let data = page_data(&page);
    assert_eq!(data["advice"]["schema"], "lancer-advise-1");
    let script = "const image = document.querySelector('#maps img'), box = image.getBoundingClientRect();\
        image.dispatchEvent(new MouseEvent('mousemove', { clientX: box.left + box.width * 7.5 / 12, clientY: box.top + box.height * 3.5 / 9 }));\
        document.querySelector('#functions th').click(); document.querySelector('#functions th').click();\
        document.getElementById('slider').value = 20; document.getElementById('slider').oninput();";
    let Some(dom) = session.browse(&page, script) else {
        println!("no browser is installed");
        return;
    };
    assert!(dom.contains("data-ready=\"yes\""), "the page's script did not end: {dom}");
    // Operations of pixel 7,3 as the picture's map has them.
    let one = session.json(&format!("render {TINY} --pixel 7,3"));
    let operations: u64 =
        ["add", "sub", "mul", "div", "cmp"].iter().map(|class| one["counts"][class].as_u64().unwrap()).sum();
    let expected = format!("pixel 7,3: {} operations, difference ", lancer::numeral::grouped(operations));
    assert!(dom.contains(&expected), "{expected}");
    // Names from a to z after one click, from z to a after the other.
    let functions = dom.split_once("id=\"functions\"").unwrap().1.split_once("</table>").unwrap().0;
    let cells: Vec<&str> =
        functions.split("<td class=\"c\">").skip(1).map(|cell| cell.split('<').next().unwrap()).collect();
    assert!(cells.len() > 10 && cells.is_sorted_by(|a, b| a >= b), "{cells:?}");
    assert!(dom.contains("inset(0px 80% 0px 0px)"), "the slider moves the picture");
    for words in ["The bus limits this machine", ">bus.octets_per_beat</td>", ">weight_cutoff</td>"] {
        assert!(dom.contains(words), "{words}");
    }
}
