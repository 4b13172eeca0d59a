//! Numbers with a unit, so that clocks and octets are never mixed up.

use std::ops::{Add, AddAssign, Sub};

use serde::{Deserialize, Serialize};

/// Makes a number with a unit.
macro_rules! quantity {
    ($(#[doc = $doc:literal])* $type:ident) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $type(pub u64);

        impl Add for $type {
            type Output = $type;
            fn add(self, other: $type) -> $type {
                $type(self.0 + other.0)
            }
        }

        impl AddAssign for $type {
            fn add_assign(&mut self, other: $type) {
                self.0 += other.0;
            }
        }

        impl Sub for $type {
            type Output = $type;
            fn sub(self, other: $type) -> $type {
                $type(self.0 - other.0)
            }
        }

        impl std::iter::Sum for $type {
            fn sum<I: Iterator<Item = $type>>(parts: I) -> $type {
                $type(parts.map(|part| part.0).sum())
            }
        }
    };
}

quantity! {
    /// A time, or a length of time, in clocks of the machine.
    Clocks
}

quantity! {
    /// A number of octets.
    Octets
}
