//! `lancer explain-pixel`: what it says of the rays against pictures, counts and double precision, and its page as a browser shows it.

use kernels::KernelSet;
use kernels::build::Crop;
use kernels::set::Formulas;
use lancer::debug::DebugTarget;
use lancer::drawing::{self, Comparison, Drawing};
use lancer::job::Job;
use lancer::load::Load;
use lancer::pixel::{ExplainedRay, PixelExplanation, PixelReplay, explain};
use lancer::registers::{RealContents, RegisterContents, ShownRegister, all};
use random::SplitMix64;
use scenes::layout::Layout;
use scenes::model::Camera;
use serde_json::Value;

use super::session::{Session, page_data};

const SIZE: (u32, u32) = (12, 9);

/// Kind and parent of each ray of a tree.
type TreeShape = Vec<(&'static str, Option<u32>)>;

/// Triangle, colour and states of the lights of a ray.
type RayFacts = (Option<u32>, Option<[i32; 3]>, Vec<Option<&'static str>>);

/// A job that is one pixel.
fn job(scene: &str, profile: KernelSet, word: u32, [column, row]: [u32; 2]) -> Job {
    let mut job = Job::new(lancer::scene(scene, None, Some(SIZE)).unwrap().scene);
    job.view.shift = [0.137, 0.071];
    job.kernels.profile = profile;
    job.machine.arithmetic.word = word;
    job.kernels.crop = Some(Crop { column, row, width: 1, height: 1 });
    job
}

/// The core of a job's pixel, and its explanation.
fn explained(job: &Job) -> (DebugTarget, PixelExplanation) {
    let (load, image) = Load::picture(job).unwrap();
    let crop = load.build.crop;
    let target = DebugTarget::pixel("pixel".into(), load, job.machine.clone()).unwrap();
    let explanation = explain(job, &image, [crop.column, crop.row], &mut target.stepper().unwrap()).unwrap();
    (target, explanation)
}

fn calls(drawing: &Drawing, name: &str) -> u64 {
    let regions = &drawing.frame.profile.as_ref().unwrap().regions;
    regions.iter().filter(|region| region.name == name).map(|region| region.calls).sum()
}

/// Sums, counts and colours of a pixel are those of its picture; yields the explanation.
fn check(job: &Job) -> PixelExplanation {
    let drawing = drawing::draw(job, Comparison::Reference, &mut |_| {}).unwrap();
    let (_, pixel) = explained(job);
    let name = format!("{} {} {:?}", pixel.scene, pixel.profile, pixel.pixel);
    assert_eq!(pixel.colour.raw, Some(drawing.words[0]), "{name}");
    assert_eq!(pixel.colour.reference, Some(drawing.reference.as_ref().unwrap().pixels[0]), "{name}");
    assert_eq!(pixel.colour.value, Some(drawing.picture.pixels[0]), "{name}");
    assert_eq!(pixel.instructions, drawing.frame.items[0].instructions, "{name}");
    let rays = lancer::Render::new(job, &drawing).rays;
    // Calls of the report's kernels do not tell total reflection, which they decide where the refracted ray is made.
    match job.kernels.profile.formulas() {
        Formulas::Printed => assert_eq!(pixel.machine_rays.all(), rays.all(), "{name}"),
        _ => assert_eq!(pixel.machine_rays, rays, "{name}"),
    }
    // What the rays add is the pixel, word by word.
    let mut sum = [0i32; 3];
    for ray in pixel.rays.iter().filter(|ray| ray.step.is_some()) {
        if let Some(added) = ray.added.raw {
            sum = [0, 1, 2].map(|k| sum[k] + added[k]);
            assert_eq!(ray.sum.raw, Some(sum), "{name}: ray {}", ray.number);
        }
    }
    assert_eq!(Some(sum), pixel.colour.raw, "{name}");
    if calls(&drawing, "packet") > 0 {
        assert_eq!(pixel.packets, calls(&drawing, "packet"), "{name}");
    }
    if calls(&drawing, "triangle") > 0 {
        assert_eq!(pixel.triangles, calls(&drawing, "triangle"), "{name}");
    }
    pixel
}

#[test]
fn rays_and_colours_are_those_of_the_picture_for_all_kernels_and_words() {
    for scene in ["cornell", "mirrors", "slabs"] {
        for place in [[5, 4], [7, 6]] {
            let mut trees: Vec<(&str, TreeShape)> = Vec::new();
            for &profile in KernelSet::ALL {
                for word in [32, 20] {
                    let pixel = check(&job(scene, profile, word, place));
                    assert!(pixel.packets > 0 && pixel.triangles > 0, "{scene} {profile}");
                    if word == 32 {
                        let ways = pixel.rays.iter().map(|ray| (ray.kind, ray.parent)).collect();
                        trees.push((profile.name(), ways));
                    }
                }
            }
            // Ray trees of 32 bits are alike, whichever kernels follow them.
            for (name, tree) in &trees[1..] {
                assert_eq!(tree, &trees[0].1, "{scene} {place:?}: {name} and {}", trees[0].0);
            }
        }
    }
}

#[test]
fn a_ray_that_misses_the_scene_is_a_ray() {
    for &profile in KernelSet::ALL {
        // One passes beside the scene's box and has no search, the other one meets the box alone.
        for (scene, camera) in [
            ("sphereflake", Camera::Perspective { eye: None, look: None, field: 140.0 }),
            ("triangle", Camera::Orthographic),
        ] {
            let mut job = job(scene, profile, 32, [0, 0]);
            (job.view.camera, job.view.background) = (camera, [0.25, 0.5, 0.125]);
            let pixel = check(&job);
            let ray = &pixel.rays[0];
            assert_eq!((pixel.rays.len(), pixel.parted, ray.hit.is_none()), (1, None, true), "{profile}");
            assert_eq!(
                (ray.packets > 0, ray.origin.value.is_some()),
                (scene == "triangle", scene == "triangle"),
                "{profile}"
            );
            assert_eq!(
                (pixel.colour.value, ray.local.value),
                (Some(job.view.background), Some(job.view.background)),
                "{profile}"
            );
        }
    }
}

#[test]
fn every_layout_of_memory_has_the_same_rays() {
    for &profile in KernelSet::ALL {
        let expected = check(&job("cornell", profile, 24, [5, 4]));
        for layout in Layout::ALL.into_iter().filter(|&layout| layout != Layout::Report) {
            let mut job = job("cornell", profile, 24, [5, 4]);
            job.layout = Some(layout);
            let Ok((_, image)) = Load::picture(&job) else { continue };
            let pixel = check(&job);
            // Where kernels are made for the report's layout, its coordinates are coarser than all others.
            if job.kernels.profile.layout() != Layout::Report {
                let shape = |pixel: &PixelExplanation| -> Vec<RayFacts> {
                    let hit = |ray: &ExplainedRay| ray.hit.as_ref().and_then(|hit| hit.triangle);
                    let lights = |ray: &ExplainedRay| ray.lights.iter().map(|light| light.state).collect();
                    pixel.rays.iter().map(|ray| (hit(ray), ray.added.raw, lights(ray))).collect()
                };
                assert_eq!(shape(&pixel), shape(&expected), "{profile} {layout} {:?}", image.layout);
            }
        }
    }
}

#[test]
fn thirty_two_bits_come_near_double_precision_at_every_ray() {
    let near = |name: &str, difference: Option<f64>, limit: f64| {
        let difference = difference.unwrap_or_else(|| panic!("{name} has no difference")).abs();
        assert!(difference < limit, "{name} is off by {difference}");
    };
    // Three sets of kernels, each at a pixel where the machine's rays go the way of those in double precision
    for (scene, profile) in [("cornell", KernelSet::Vector), ("mirrors", KernelSet::Ray), ("slabs", KernelSet::Packet)]
    {
        let pixel = check(&job(scene, profile, 32, [5, 4]));
        assert_eq!((pixel.parted, pixel.machine_rays), (None, pixel.reference_rays), "{scene}");
        let mut hits = 0;
        for ray in &pixel.rays {
            let largest =
                |difference: Option<[f64; 3]>| difference.map(|d| d.into_iter().fold(0.0, |a: f64, b| a.max(b.abs())));
            near("weight", ray.weight.difference, 1e-7);
            near("origin", largest(ray.origin.difference), 1e-6);
            near("direction", largest(ray.direction.difference), 1e-6);
            near("local", largest(ray.local.difference), 1e-6);
            near("added", largest(ray.added.difference), 1e-6);
            near("sum", largest(ray.sum.difference), 1e-6);
            let Some(hit) = &ray.hit else { continue };
            hits += 1;
            near("t", hit.t.difference, 1e-6);
            near("u", hit.u.difference, 1e-4);
            near("v", hit.v.difference, 1e-4);
            near("point", largest(hit.point.difference), 1e-6);
            near("normal", largest(hit.normal.difference), 1e-6);
            for light in &ray.lights {
                assert_eq!(light.state, light.reference_state);
                // A light that no shadow ray was sent to has no numbers to compare.
                if light.step.is_some() {
                    near("cosine", light.cosine.difference, 1e-6);
                    near("distance", light.distance.difference, 1e-6);
                    near("direction to the light", largest(light.direction.difference), 1e-6);
                }
                assert_eq!(light.blocker.is_some(), light.state == Some("hidden"));
            }
        }
        // Without a hit most quantities would go uncompared.
        assert!(hits > 0, "{scene}");
    }
}

#[test]
fn a_wrong_kernel_parts_from_double_precision_where_it_is_wrong() {
    let session = Session::new();
    let shade = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/kernels/asm/vector/reflect.s")).unwrap();
    // A mirror that sends rays on as if it were not there.
    let wrong = shade.replace("    vmov  origin, point\n", "    vmov  origin, point\n    vmov  direction, incident\n");
    assert_ne!(wrong, shade);
    session.write("reflect.s", &wrong);
    let pixel = "explain-pixel mirrors 5,4 --size 12x9 --shift 0.137,0.071";
    let run = session.run(&format!("{pixel} --kernel reflect=reflect.s --json"));
    let wrong: Value = serde_json::from_str(&run.out).unwrap();
    let right = session.json(pixel);
    assert_eq!((right["parted"].clone(), right["rays"][0].clone()), (Value::Null, wrong["rays"][0].clone()));
    assert!(wrong["parted"].as_u64().is_some_and(|ray| ray > 0), "{}", wrong["parted"]);
    let kinds =
        wrong["machine_rays"]["reflected"].as_u64().unwrap() + wrong["machine_rays"]["refracted"].as_u64().unwrap();
    assert!(kinds > 0, "{}", wrong["machine_rays"]);
}

#[test]
fn the_text_is_a_tree_of_eighty_columns() {
    let session = Session::new();
    for scene in ["slabs", "mirrors", "cornell", "empty"] {
        let text = session.succeed(&format!("explain-pixel {scene} 5,4 --size 12x9 --shift 0.137,0.071"));
        let wide: Vec<&str> = text.lines().filter(|line| line.chars().count() > 80).collect();
        assert!(wide.is_empty(), "{scene}: {wide:?}");
        assert!(text.starts_with(&format!("pixel 5,4 of {scene}, 12 x 9: kernels vector\n")), "{text}");
        assert!(text.contains("0 camera ray\n"), "{text}");
    }
    let text = session.succeed("explain-pixel slabs 5,4 --size 12x9 --shift 0.137,0.071");
    for words in ["├ 1 reflected ray", "└ ", " refracted ray", "meets triangle ", "light 0", "kt ", "off "] {
        assert!(text.contains(words), "{words}: {text}");
    }
    session.fail("explain-pixel cornell 12,4 --size 12x9", 2, "pixel 12,4 lies outside a picture of 12 x 9 pixels");
    session.fail("explain-pixel cornell", 2, "X,Y");
    session.fail("explain-pixel cornell 1,1 --steps 0..5", 2, "--html");
    session.fail("explain-pixel cornell --crop 0,0,2,2 --size 12x9", 2, "one pixel is explained");
    session.fail("explain-pixel cornell 1,1 --size 12x9 --html no/p.html", 1, "there is no folder no");
    session.fail("explain-pixel cornell 1,1 --size 12x9 --html p.html --steps 90000..", 2, "the pixel is over after");
    assert_eq!(session.names(), Vec::<String>::new());
}

#[test]
fn scenes_of_any_size_are_shown_in_their_own_units() {
    let plain = job("mirrors", KernelSet::Vector, 32, [5, 4]);
    let (target, explanation) = explained(&plain);
    // A power of two changes no raw number, and real ones by itself.
    for power in [300, -300, 900, -900] {
        let grow = |x: f64| x * 2f64.powi(power);
        let mut job = plain.clone();
        job.scene.vertices.iter_mut().for_each(|vertex| *vertex = vertex.map(grow));
        job.scene.lights.iter_mut().for_each(|light| light.position = light.position.map(grow));
        let (far, grown) = explained(&job);
        assert_eq!((grown.parted, grown.colour), (explanation.parted, explanation.colour), "2^{power}");
        for (ray, other) in explanation.rays.iter().zip(&grown.rays) {
            assert_eq!(
                (ray.origin.raw, ray.origin.value.map(|place| place.map(grow))),
                (other.origin.raw, other.origin.value)
            );
            assert_eq!(ray.direction, other.direction);
            let t = |ray: &ExplainedRay| ray.hit.as_ref().map(|hit| (hit.t.raw, hit.t.value, hit.t.reference));
            let larger = t(ray).map(|(raw, value, reference)| (raw, value.map(grow), reference.map(grow)));
            assert_eq!(larger, t(other), "2^{power}");
        }
        // Registers, too: those of traces, of the debugger and of the page.
        let step = explanation.rays[1].step.unwrap();
        let shown = |target: &DebugTarget| {
            let mut stepper = target.stepper().unwrap();
            stepper.run_to(step);
            let pc = stepper.code.word(stepper.state().pc);
            let shown = |register| ShownRegister::at(&target.program, &stepper.state().registers, register, pc);
            [shown(('v', 1)), shown(('s', 3))]
        };
        for (small, large) in shown(&target).into_iter().zip(shown(&far)) {
            assert_eq!(
                (small.raw, small.fraction_bits.unwrap()),
                (large.raw, large.fraction_bits.unwrap() + power),
                "{large:?}"
            );
            let numbers = |real: Option<RealContents>| match real {
                Some(RealContents::One(number)) => vec![number],
                Some(RealContents::Three(numbers)) => numbers.to_vec(),
                None => panic!("registers of known formats have real values"),
            };
            for (small, large) in numbers(small.real).into_iter().zip(numbers(large.real)) {
                assert!((grow(small) - large).abs() <= 1e-6 * large.abs(), "{small} {large}");
            }
        }
    }
}

/// Raw registers before a step, in the order in which the page has them.
fn registers_at(target: &DebugTarget, step: u64) -> Vec<i64> {
    let mut stepper = target.stepper().unwrap();
    stepper.run_to(step);
    let word = |value: i64| [value as i32 as i64, value >> 32];
    all(&stepper.state().registers)
        .flat_map(|((file, _), contents)| match contents {
            RegisterContents::One(value) if file == 'w' => word(value).to_vec(),
            contents => contents.numbers(),
        })
        .collect()
}

#[test]
fn the_page_replays_the_pixel_in_a_browser() {
    let session = Session::new();
    let (target, explanation) = explained(&job("mirrors", KernelSet::Vector, 32, [5, 4]));
    let end = explanation.instructions;
    let mut random = SplitMix64::new(11);
    let steps: Vec<u64> = (0..40).map(|_| random.below(end + 1)).chain([0, end]).collect();
    let said = session.json("explain-pixel mirrors 5,4 --size 12x9 --shift 0.137,0.071 --html p.html");
    assert_eq!(said["instructions"], end);
    let page = String::from_utf8(session.read("p.html")).unwrap();
    let data = page_data(&page);
    assert_eq!((&data["replay"]["count"], &data["replay"]["total"]), (&end.into(), &end.into()));
    let ray = explanation.rays[1].step.unwrap();
    // Jumps, steps on and back by buttons and keys, then says where it is and which registers it has at many steps.
    let script = format!(
        "{{ const said = []; const say = () => said.push(document.body.dataset.step);\
         const click = id => {{ at(id).click(); say(); }};\
         const key = name => {{ document.dispatchEvent(new KeyboardEvent('keydown', {{ key: name, bubbles: true }})); say(); }};\
         click('on'); click('on'); click('back'); key('ArrowRight'); key('End'); key('ArrowLeft'); key('Home');\
         at('step').value = '1,234'; at('step').onchange(); say();\
         [...document.querySelectorAll('#tree button')].find(button => button.textContent.startsWith('1 ')).click(); say();\
         const where = at('place').textContent, next = at('now').textContent, shown = at('ray').textContent, table = at('registers').textContent;\
         click('ray-on'); click('ray-back');\
         const states = {steps:?}.map(step => Array.from(stateAt(step).raw));\
         const out = document.createElement('pre'); out.id = 'out';\
         out.textContent = JSON.stringify({{ said, states, where, next, shown, table }}); document.body.append(out); }}"
    );
    let Some(dom) = session.browse(&page, &script) else {
        println!("no browser is installed");
        return;
    };
    assert!(dom.contains("data-ready=\"yes\""), "the page's script did not end: {dom}");
    let out = dom.split_once("<pre id=\"out\">").expect("the test's script ended").1.split_once("</pre>").unwrap().0;
    let unescaped = out.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    let out: Value = serde_json::from_str(&unescaped).unwrap();
    let said: Vec<u64> =
        out["said"].as_array().unwrap().iter().map(|step| step.as_str().unwrap().parse().unwrap()).collect();
    assert_eq!(said[..9], [1, 2, 1, 2, end, end - 1, 0, 1234, ray], "{said:?}");
    assert!(said[9] > ray && said[10] == ray, "{said:?}");
    for (step, state) in steps.iter().zip(out["states"].as_array().unwrap()) {
        let state: Vec<i64> = state.as_array().unwrap().iter().map(|word| word.as_i64().unwrap()).collect();
        assert_eq!(state, registers_at(&target, *step), "step {step}");
    }
    // At the ray: its search, the source, the origin as a real number, and its figures.
    let text = |key: &str| out[key].as_str().unwrap();
    assert!(
        text("where").starts_with("kernels/asm/vector/trace.s:") && text("where").ends_with(" in trace"),
        "{}",
        text("where")
    );
    assert!(
        text("next").contains("next: ") && text("shown").contains("reflected"),
        "{} {}",
        text("next"),
        text("shown")
    );
    let mut stepper = target.stepper().unwrap();
    stepper.run_to(ray);
    let pc = stepper.code.word(stepper.state().pc);
    let origin = ShownRegister::at(&target.program, &stepper.state().registers, ('v', 1), pc);
    assert!(
        text("table").contains("origin") && text("table").contains(&origin.raw.raw_text().replace(':', " ")),
        "{}",
        text("table")
    );
}

#[test]
fn a_page_of_a_part_says_what_is_left_out() {
    let session = Session::new();
    let run = session.run("explain-pixel cornell 5,4 --size 12x9 --html p.html --steps 100..300");
    assert_eq!(run.code, 0);
    let total = page_data(&String::from_utf8(session.read("p.html")).unwrap())["replay"]["total"].as_u64().unwrap();
    let expected = format!(
        "{} instructions are not on the page; --steps A..B chooses others\n",
        lancer::numeral::grouped(total - 200)
    );
    assert_eq!(run.messages, expected);
}

/// Octets of a text in base 64, as RFC 4648 has it.
fn base64(text: &str) -> Vec<u8> {
    let letters = ('A'..='Z').chain('a'..='z').chain('0'..='9').chain(['+', '/']).collect::<String>();
    let bits: Vec<u32> = text.trim_end_matches('=').chars().map(|c| letters.find(c).unwrap() as u32).collect();
    let octets = |four: &[u32]| {
        let whole = (0..4).fold(0, |whole, k| whole << 6 | four.get(k).copied().unwrap_or(0));
        (0..four.len() * 6 / 8).map(move |k| (whole >> (16 - 8 * k)) as u8).collect::<Vec<u8>>()
    };
    bits.chunks(4).flat_map(octets).collect()
}

/// The first error is that of one rounding, half an ulp at most; an integer has none.
#[test]
fn errors_of_registers_are_those_of_shadows() {
    let (mut target, explanation) = explained(&job("cornell", KernelSet::Vector, 32, [5, 4]));
    let total = explanation.instructions;
    let record = |target: &DebugTarget| {
        let replay = PixelReplay::record(&mut target.stepper().unwrap(), 0..total, total);
        serde_json::to_value(replay).unwrap()
    };
    let plain = record(&target);
    assert_eq!(plain["errors"], Value::Null);
    target.has_shadow = true;
    let with = record(&target);
    assert_eq!(with["values"], plain["values"]);
    // One number for each word that is written.
    let octets = |value: &Value| base64(value.as_str().unwrap());
    let errors: Vec<f32> =
        octets(&with["errors"]).as_chunks().0.iter().map(|&octets| f32::from_le_bytes(octets)).collect();
    assert_eq!(4 * errors.len(), octets(&with["values"]).len());
    let first = errors.iter().find(|error| error.abs() > 0.0).unwrap();
    assert!(first.abs() <= 0.5, "{first}");
    let integers = errors.iter().filter(|error| error.is_nan()).count();
    let exact = errors.iter().filter(|&&error| error == 0.0).count();
    assert!([integers, exact, errors.len() - integers - exact].iter().all(|&count| count > 100), "{integers} {exact}");
}
