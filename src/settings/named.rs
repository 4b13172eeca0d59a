//! Names of choices in settings: a value of a list such as the layouts is written as its name, and a wrong name is answered by those that there are.

use emu::engine::EngineKind;
use kernels::{KernelSet, Skip};
use scenes::kdtree::{BuildMethod, DEEPEST, Depth};
use scenes::layout::Layout;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

/// The engine is chosen: the best that suits.
pub const AUTO: &str = "auto";

/// A choice that has a name.
pub trait NamedChoice: Sized {
    /// The name that stands in settings.
    fn name(&self) -> String;

    /// The choice of a name.
    fn named(name: &str) -> Option<Self>;

    /// All names, for messages.
    fn names() -> Vec<String>;
}

macro_rules! named {
    ($($type:ty, $all:expr;)*) => {$(
        impl NamedChoice for $type {
            fn name(&self) -> String {
                <$type>::name(*self).to_owned()
            }

            fn named(name: &str) -> Option<Self> {
                $all.iter().copied().find(|one: &$type| one.name() == name)
            }

            fn names() -> Vec<String> {
                $all.iter().map(|one: &$type| one.name().to_owned()).collect()
            }
        }
    )*};
}

named! {
    KernelSet, KernelSet::ALL;
    Skip, Skip::ALL;
    Layout, Layout::ALL;
    BuildMethod, BuildMethod::ALL;
}

impl NamedChoice for EngineKind {
    fn name(&self) -> String {
        if *self == EngineKind::default() { AUTO.to_owned() } else { EngineKind::name(*self).to_owned() }
    }

    fn named(name: &str) -> Option<Self> {
        EngineKind::named(name).or_else(|| (name == AUTO).then(EngineKind::default))
    }

    fn names() -> Vec<String> {
        std::iter::once(AUTO).chain(EngineKind::ALL.map(EngineKind::name)).map(str::to_owned).collect()
    }
}

impl NamedChoice for Depth {
    fn name(&self) -> String {
        match self {
            Depth::Levels(levels) => levels.to_string(),
            Depth::Auto => AUTO.to_owned(),
        }
    }

    fn named(name: &str) -> Option<Self> {
        match name.parse() {
            Ok(levels @ 0..=DEEPEST) => Some(Depth::Levels(levels)),
            _ => (name == AUTO).then_some(Depth::Auto),
        }
    }

    fn names() -> Vec<String> {
        vec![format!("0..{DEEPEST}"), AUTO.to_owned()]
    }
}

/// A name, or a number that is one.
#[derive(Deserialize)]
#[serde(untagged)]
enum NameOrNumber {
    Text(String),
    Number(u64),
}

fn find<T: NamedChoice, E: Error>(word: NameOrNumber) -> Result<T, E> {
    let name = match word {
        NameOrNumber::Text(text) => text,
        NameOrNumber::Number(number) => number.to_string(),
    };
    T::named(&name)
        .ok_or_else(|| E::custom(format!("unknown name `{name}`, expected one of `{}`", T::names().join("`, `"))))
}

/// Writes a choice as its name.
pub fn serialize<T: NamedChoice, S: Serializer>(choice: &T, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&choice.name())
}

/// Reads a choice by its name.
pub fn deserialize<'de, T: NamedChoice, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    find(NameOrNumber::deserialize(deserializer)?)
}

/// A choice that may be left to what goes with the others.
pub mod option {
    use super::{Deserialize, Deserializer, NameOrNumber, NamedChoice, Serializer, find};

    /// Writes the name, or null.
    pub fn serialize<T: NamedChoice, S: Serializer>(choice: &Option<T>, serializer: S) -> Result<S::Ok, S::Error> {
        match choice {
            Some(choice) => serializer.serialize_some(&choice.name()),
            None => serializer.serialize_none(),
        }
    }

    /// Reads a name, or null.
    pub fn deserialize<'de, T: NamedChoice, D: Deserializer<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
        Option::<NameOrNumber>::deserialize(deserializer)?.map(find).transpose()
    }
}

/// Levels of the kd tree: a number, `auto`, or null for those of the kernels.
pub mod depth {
    use serde::{Deserializer, Serializer};

    use super::{Depth, option};

    /// Writes the number, `auto`, or null.
    pub fn serialize<S: Serializer>(depth: &Option<Depth>, serializer: S) -> Result<S::Ok, S::Error> {
        match depth {
            Some(Depth::Levels(levels)) => serializer.serialize_u32(*levels),
            _ => option::serialize(depth, serializer),
        }
    }

    /// Reads a number, `auto`, or null.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Depth>, D::Error> {
        option::deserialize(deserializer)
    }
}

/// Skips as a list of names, in the order in which `lancer skips` lists them.
pub mod skips {
    use kernels::Skips;
    use serde::ser::SerializeSeq;

    use super::{Deserialize, Deserializer, NameOrNumber, Serializer, Skip, find};

    /// Writes the names of the skips that there are.
    pub fn serialize<S: Serializer>(skips: &Skips, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(None)?;
        for skip in Skip::ALL.iter().filter(|&&skip| skips.has(skip)) {
            list.serialize_element(skip.name())?;
        }
        list.end()
    }

    /// Reads names.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Skips, D::Error> {
        let words = Vec::<NameOrNumber>::deserialize(deserializer)?;
        words.into_iter().try_fold(Skips::NONE, |skips, word| Ok(skips.with(find(word)?)))
    }
}
