//! `[protection]` of a machine file: what each structure is protected by. Clocks and octets of check bits follow from it; what a protection sees
//! of a fault is not said here.

use std::collections::BTreeMap;
use std::fmt;

use messages::Diagnostic;
use serde::de::{DeserializeSeed, Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::code::quantity::Octets;
use crate::machine::{FaultKind, Protection};

/// Bits of a word that has check bits, whatever the machine's word length.
pub const WORD_BITS: u32 = 32;

/// Protection of each structure and part of the machine, written as a table of names; what it leaves out has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(into = "BTreeMap<&'static str, &'static str>")]
pub struct ProtectionConfig([Protection; FaultKind::ALL.len()]);

impl ProtectionConfig {
    /// Keys of the table: all that some protection is made for.
    pub fn keys() -> impl Iterator<Item = FaultKind> {
        FaultKind::ALL.into_iter().filter(|kind| !kind.protections().is_empty())
    }

    /// Protection of a structure.
    pub const fn of(&self, kind: FaultKind) -> Protection {
        self.0[kind as usize]
    }

    /// Protects a structure, or leaves it unprotected.
    pub const fn set(&mut self, kind: FaultKind, protection: Protection) {
        self.0[kind as usize] = protection;
    }

    /// The structures that are protected, with their protections.
    pub fn iter(&self) -> impl Iterator<Item = (FaultKind, Protection)> + '_ {
        let all = FaultKind::ALL.into_iter().map(|kind| (kind, self.of(kind)));
        all.filter(|(_, protection)| *protection != Protection::Unprotected)
    }

    /// Nothing is protected.
    pub fn is_none(&self) -> bool {
        self.iter().next().is_none()
    }

    /// Check bits that go over the bus with each word of 32: those that global memory keeps, and those of the bus itself.
    pub const fn moved_bits(&self) -> u32 {
        self.of(FaultKind::Memory).check_bits() + self.of(FaultKind::Bus).check_bits()
    }

    /// Octets of check bits that go over the bus with so many octets, rounded down.
    pub fn check_octets(&self, moved: Octets) -> Octets {
        Octets((u128::from(moved.0) * u128::from(self.moved_bits()) / u128::from(WORD_BITS)) as u64)
    }

    /// Times that each elementary operation is executed.
    pub const fn executions(&self) -> u64 {
        match self.of(FaultKind::Results) {
            Protection::Duplicated => 2,
            _ => 1,
        }
    }

    /// Protections that are not made for their structures, by their keys, with what to say about each.
    pub(super) fn misplaced(&self) -> Vec<(String, Diagnostic)> {
        let wrong = self.iter().filter(|(kind, protection)| !kind.protections().contains(protection));
        let message = |(kind, protection): (FaultKind, Protection)| {
            let key = format!("protection.{}", kind.name());
            let names: Vec<&str> = kind.protection_names().collect();
            let message = format!("`{key}` is `{}`, but must be one of {}", protection.name(), names.join(", "));
            let made_for = ProtectionConfig::keys().filter(|kind| kind.protections().contains(&protection));
            let made_for: Vec<&str> = made_for.map(FaultKind::name).collect();
            let hint = format!("`{}` protects {}", protection.name(), made_for.join(", "));
            (key, Diagnostic::error(message).hint(hint))
        };
        wrong.map(message).collect()
    }
}

/// Name of a structure as a key, so that a message about an unknown one has the key's place.
struct ProtectedKey(FaultKind);

impl<'de> Deserialize<'de> for ProtectedKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<ProtectedKey, D::Error> {
        let name = String::deserialize(deserializer)?;
        let names = || ProtectionConfig::keys().map(|kind| format!("`{}`", kind.name())).collect::<Vec<_>>().join(", ");
        let unknown = || D::Error::custom(format!("unknown structure `{name}`, expected one of {}", names()));
        ProtectionConfig::keys().find(|kind| kind.name() == name).map(ProtectedKey).ok_or_else(unknown)
    }
}

/// Reads the protection of a structure, so that a message about an unknown one names those of this structure. One of another structure is read: what
/// it is made for is said where ranges are checked.
struct ProtectionSeed(FaultKind);

impl<'de> DeserializeSeed<'de> for ProtectionSeed {
    type Value = Protection;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Protection, D::Error> {
        let name = String::deserialize(deserializer)?;
        let names = || self.0.protection_names().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        Protection::from_name(&name)
            .ok_or_else(|| D::Error::custom(format!("unknown protection `{name}`, expected one of {}", names())))
    }
}

/// Reads the table.
struct ProtectionTable;

impl<'de> Visitor<'de> for ProtectionTable {
    type Value = ProtectionConfig;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut table: A) -> Result<ProtectionConfig, A::Error> {
        let mut all = ProtectionConfig::default();
        while let Some(ProtectedKey(kind)) = table.next_key()? {
            all.set(kind, table.next_value_seed(ProtectionSeed(kind))?);
        }
        Ok(all)
    }
}

impl<'de> Deserialize<'de> for ProtectionConfig {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<ProtectionConfig, D::Error> {
        deserializer.deserialize_map(ProtectionTable)
    }
}

impl From<ProtectionConfig> for BTreeMap<&'static str, &'static str> {
    fn from(all: ProtectionConfig) -> BTreeMap<&'static str, &'static str> {
        ProtectionConfig::keys().map(|kind| (kind.name(), all.of(kind).name())).collect()
    }
}
