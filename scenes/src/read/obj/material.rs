//! The reader of `.mtl` material libraries, and what their coefficients are in the report's model of light (4.3).

use std::sync::Arc;

use messages::{Diagnostic, Report, Source};

use super::super::mesh::GREY;
use super::super::words::{Word, Words, counted, shortened};
use super::statement;
use crate::model::{Material, Vec3};

/// A material as the library describes it.
#[derive(Clone, Debug)]
struct Draft<'a> {
    name: &'a str,
    /// Kd.
    diffuse: Vec3,
    /// Ks.
    specular: Vec3,
    /// d, clamped to 0 to 1, and its number in the text.
    opacity: Option<(f64, Word<'a>)>,
    /// Tr, the same way.
    transparency: Option<(f64, Word<'a>)>,
    /// Ni.
    refraction: f64,
    /// Illumination model 0 to 10; highlights where it is not given.
    model: u32,
}

/// Statements of a library that no material of a scene can follow.
#[derive(Default)]
struct LostProperties<'a> {
    textures: usize,
    highlights: usize,
    emissions: usize,
    tints: usize,
    physical: usize,
    clamped: usize,
    unread: Option<Word<'a>>,
    more_unread: usize,
}

/// The materials of a library in its order, and errors and warnings about it.
pub(super) fn parse(source: &Arc<Source>) -> (Vec<(String, Material)>, Report) {
    let mut words = Words::new(source, if source.text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 });
    let mut materials = Vec::new();
    let mut lost = LostProperties::default();
    let mut draft = None;
    let mut arguments = Vec::new();
    while let Some(keyword) = statement::next(&mut words, &mut arguments) {
        if keyword.text == "newmtl" {
            // A material ends where the next one begins
            materials.extend(draft.take().map(|draft| finish(&mut words, draft, &mut lost)));
            let name = words.line_from(keyword.span().end).text;
            if name.is_empty() {
                words.refuse(keyword, "a material needs a name", "no name follows");
            }
            // A material that says no more is grey, opaque and without reflection.
            let (diffuse, specular) = (GREY.colour, [0.0; 3]);
            draft =
                Some(Draft { name, diffuse, specular, opacity: None, transparency: None, refraction: 1.0, model: 2 });
        } else if let Some(draft) = &mut draft {
            read(&mut words, keyword, &arguments, draft, &mut lost);
        } else {
            // One complaint is enough: where this is no library, each line would bring another.
            let message = format!("`{}` stands before the first `newmtl`", shortened(keyword.text));
            words.refuse(keyword, message, "of which material?");
            break;
        }
        if words.is_lost() {
            break;
        }
    }
    materials.extend(draft.map(|draft| finish(&mut words, draft, &mut lost)));
    lost.complain(&mut words, &source.name);
    (materials, words.into_report())
}

/// Reads one statement of a material.
fn read<'a>(
    words: &mut Words<'a>,
    keyword: Word<'a>,
    arguments: &[Word<'a>],
    draft: &mut Draft<'a>,
    lost: &mut LostProperties<'a>,
) {
    let mut clamp = |value: f64| {
        let clamped = value.clamp(0.0, 1.0);
        lost.clamped += usize::from(clamped != value);
        // No negative zeros.
        clamped + 0.0
    };
    match keyword.text {
        "Kd" | "Ks" | "Ke" | "Tf" => {
            if arguments.first().is_some_and(|word| ["spectral", "xyz"].contains(&word.text)) {
                lost.unread(keyword);
                return;
            }
            let Some(colour) = colour(words, keyword, arguments) else { return };
            match keyword.text {
                "Kd" => draft.diffuse = colour.map(clamp),
                "Ks" => draft.specular = colour.map(clamp),
                "Ke" => lost.emissions += usize::from(colour != [0.0; 3]),
                _ => lost.tints += usize::from(colour != [1.0; 3]),
            }
        }
        "d" | "Tr" => {
            let halo = usize::from(arguments.first().is_some_and(|word| word.text == "-halo"));
            let Some(value) = one(words, keyword, &arguments[halo..]) else { return };
            let given = Some((clamp(value), arguments[halo]));
            *if keyword.text == "d" { &mut draft.opacity } else { &mut draft.transparency } = given;
        }
        "Ni" => {
            let Some(value) = one(words, keyword, arguments) else { return };
            if value < 0.0 {
                words.refuse(arguments[0], "an index of refraction must not be negative", "negative");
            }
            draft.refraction = value;
        }
        "illum" => match arguments.first() {
            Some(&word) => match words.whole(word, || "the number of an illumination model".to_string()) {
                Some(model) if model > 10 => words.refuse(word, "illumination models go from 0 to 10", "no such model"),
                Some(model) => draft.model = model,
                None => {}
            },
            None => words.refuse(keyword, "`illum` needs the number of an illumination model", "nothing follows"),
        },
        // The report's ambient light has the diffuse colour, and highlights have no size.
        "Ka" | "Km" | "Ns" | "sharpness" | "map_aat" => {}
        "bump" | "disp" | "decal" | "refl" | "norm" => lost.textures += 1,
        "Pr" | "Pm" | "Ps" | "Pc" | "Pcr" | "aniso" | "anisor" => lost.physical += 1,
        text if text.starts_with("map_") => lost.textures += 1,
        _ => lost.unread(keyword),
    }
}

/// Three components, or one that stands for all.
fn colour(words: &mut Words<'_>, keyword: Word<'_>, arguments: &[Word<'_>]) -> Option<Vec3> {
    let what = || format!("a component of `{}`", keyword.text);
    let mut component = |word| match keyword.text {
        "Kd" | "Ks" => words.number(word, what),
        _ => words.unused_number(word, what),
    };
    match *arguments {
        [all] => Some([component(all); 3]),
        [red, green, blue] => Some([red, green, blue].map(component)),
        _ => {
            let message = format!("`{}` should have 3 components", keyword.text);
            let place = words.place(statement::span(keyword, arguments));
            words.complain(Diagnostic::error(message).at(place, counted(arguments.len(), "number", "numbers")));
            None
        }
    }
}

/// The number of a statement that has one.
fn one(words: &mut Words<'_>, keyword: Word<'_>, arguments: &[Word<'_>]) -> Option<f64> {
    let &[word] = arguments else {
        let message = format!("`{}` should have one number", keyword.text);
        let place = words.place(statement::span(keyword, arguments));
        words.complain(Diagnostic::error(message).at(place, counted(arguments.len(), "number", "numbers")));
        return None;
    };
    Some(words.number(word, || format!("the value of `{}`", keyword.text)))
}

/// The material in the report's coefficients.
///
/// - ks is the mean of Ks where the illumination model reflects (3 to 9), else 0.
/// - Where d is below 1, the material is transparent: what ks leaves is shared in the ratio of d to 1 - d by kd and
///   kt, the colour is Kd, the index of refraction Ni.
/// - Otherwise kd times the colour is Kd, and kd is 1 - ks if Kd is no brighter than that.
fn finish(words: &mut Words<'_>, draft: Draft<'_>, lost: &mut LostProperties<'_>) -> (String, Material) {
    let is_reflecting = (3..=9).contains(&draft.model);
    let [red, green, blue] = draft.specular;
    // The mean of three equal numbers is not always the same bits.
    let mean = if red == green && green == blue { red } else { (red + green + blue) / 3.0 };
    lost.highlights += usize::from(!is_reflecting && draft.model == 2 && mean > 0.0);
    let reflection = if is_reflecting { mean.min(1.0) } else { 0.0 };
    let opacity = opacity(words, &draft);
    let material = if opacity < 1.0 {
        let index = if draft.refraction > 0.0 { draft.refraction } else { 1.0 };
        Material { colour: draft.diffuse, reflection, intensity: opacity * (1.0 - reflection), index }
    } else {
        let intensity = draft.diffuse.into_iter().fold(1.0 - reflection, f64::max);
        let colour = draft.diffuse.map(|c| if intensity > 0.0 { c / intensity } else { 0.0 });
        Material { colour, reflection, intensity, index: 0.0 }
    };
    (draft.name.to_string(), material)
}

/// The opacity, 1 where none is given. `d` counts where `Tr` is not what it leaves: some programs mean `d` by both.
fn opacity(words: &mut Words<'_>, draft: &Draft<'_>) -> f64 {
    let (opacity, word, (transparency, other)) = match (draft.opacity, draft.transparency) {
        (None, None) => return 1.0,
        (None, Some((transparency, _))) => return 1.0 - transparency,
        (Some((opacity, _)), None) => return opacity,
        (Some((opacity, word)), Some(transparency)) => (opacity, word, transparency),
    };
    // Programs write as few as three digits.
    if (opacity + transparency - 1.0).abs() > 2e-3 {
        let message = format!(
            "`d {}` and `Tr {}` of material `{}` contradict each other: Tr is 1 - d",
            word.text,
            other.text,
            shortened(draft.name)
        );
        let warning = Diagnostic::warning(message).at(words.place(word.span()), "this counts");
        words.complain(warning.also(words.place(other.span()), "this is not used"));
    }
    opacity
}

impl<'a> LostProperties<'a> {
    fn unread(&mut self, keyword: Word<'a>) {
        match self.unread {
            None => self.unread = Some(keyword),
            Some(_) => self.more_unread += 1,
        }
    }

    fn complain(self, words: &mut Words<'a>, name: &str) {
        for (count, [one, many, rest]) in [
            (self.textures, ["texture map is", "texture maps are", "not used"]),
            (self.highlights, ["material has", "materials have", "highlights, which are not drawn"]),
            (self.emissions, ["material emits", "materials emit", "light, which is not drawn: only lights do"]),
            (self.tints, ["material tints", "materials tint", "what is seen through, which is not drawn"]),
            (
                self.physical,
                ["coefficient of roughness or metal is", "coefficients of roughness or metal are", "not used"],
            ),
            (self.clamped, ["coefficient is", "coefficients are", "clamped to 0 to 1"]),
        ] {
            if count > 0 {
                words.complain(Diagnostic::warning(format!("{name}: {} {rest}", counted(count, one, many))));
            }
        }
        if let Some(word) = self.unread {
            let mut message = format!("`{}` is not read", shortened(word.text));
            if self.more_unread > 0 {
                let more = counted(self.more_unread, "other statement is", "other statements are");
                message.push_str(&format!("; {more} not read either"));
            }
            words.complain(Diagnostic::warning(message).at(words.place(word.span()), "not read as it stands"));
        }
    }
}
