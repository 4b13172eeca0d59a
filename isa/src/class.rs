//! The classes in which operations are counted, and vectors of counts over them. Who counts is not said here.

use std::ops::{Add, AddAssign, Index, IndexMut, Sub};

/// Makes the enum, its names and its documentation from one list.
macro_rules! classes {
    ($($(#[doc = $doc:literal])* $variant:ident $name:literal,)*) => {
        /// A class of operations, as in the annexes of the report, plus what the annexes leave out.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u8)]
        pub enum Class { $($(#[doc = $doc])* $variant,)* }

        impl Class {
            /// All classes, in the order in which results list them.
            pub const ALL: &[Class] = &[$(Class::$variant),*];

            /// The name that rows, files and results use.
            pub const fn name(self) -> &'static str {
                match self { $(Class::$variant => $name,)* }
            }

            /// One line on what the class counts.
            pub const fn doc(self) -> &'static str {
                match self { $(Class::$variant => concat!($($doc),*),)* }
            }
        }
    };
}

classes! {
    /// Elementary fixed-point or integer addition.
    Add "add",
    /// Elementary subtraction or negation.
    Sub "sub",
    /// Elementary multiplication.
    Mul "mul",
    /// Elementary division.
    Div "div",
    /// Elementary comparison; a conditional branch is one.
    Cmp "cmp",
    /// Bus requests: a load, a store or a whole block transfer is one.
    Mem "mem",
    /// Octets asked of the bus.
    Octet "octet",
    /// Copies between registers and constants.
    Move "move",
    /// Bitwise logic and shifts (wiring, for the annexes).
    Logic "logic",
    /// Unconditional jumps, calls and returns.
    Jump "jump",
    /// Words read from or written to the local buffer.
    Local "local",
    /// Address and post-increment arithmetic.
    Address "address",
}

impl Class {
    /// The class of that name.
    pub const fn from_name(name: &str) -> Option<Class> {
        let mut at = 0;
        while at < Class::ALL.len() {
            if same(Class::ALL[at].name(), name) {
                return Some(Class::ALL[at]);
            }
            at += 1;
        }
        None
    }

    /// The class is one of the five elementary operations that Annex II adds up.
    pub const fn is_elementary(self) -> bool {
        matches!(self, Class::Add | Class::Sub | Class::Mul | Class::Div | Class::Cmp)
    }
}

const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    if a.len() != b.len() {
        return false;
    }
    let mut at = 0;
    while at < a.len() {
        if a[at] != b[at] {
            return false;
        }
        at += 1;
    }
    true
}

/// One number a class: a cost or a count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts(pub [u64; Class::ALL.len()]);

impl Counts {
    /// Nothing of any class.
    pub const ZERO: Counts = Counts([0; Class::ALL.len()]);

    /// The counts from (class name, number) pairs.
    ///
    /// # Panics
    /// On an unknown class name or one named twice: in a constant that does not compile.
    pub const fn from_pairs(pairs: &[(&str, u64)]) -> Counts {
        // Constant functions have no iterators.
        let mut counts = Counts::ZERO;
        let mut at = 0;
        while at < pairs.len() {
            match Class::from_name(pairs[at].0) {
                Some(class) => {
                    assert!(counts.0[class as usize] == 0, "a class is named twice");
                    counts.0[class as usize] = pairs[at].1;
                }
                None => panic!("unknown class of operations"),
            }
            at += 1;
        }
        counts
    }

    /// Each class `times` times.
    #[inline]
    pub fn times(self, times: u64) -> Counts {
        Counts(self.0.map(|count| count * times))
    }

    /// Sum of add, sub, mul, div and cmp: what Annex II calls the operations of a function.
    #[inline]
    pub fn elementary(&self) -> u64 {
        self.iter().filter(|(class, _)| class.is_elementary()).map(|(_, count)| count).sum()
    }

    /// Sum of all classes but moves, which are wiring, and octets, which are no operations: what kernels are compared by.
    pub fn operations(&self) -> u64 {
        self.iter().filter(|(class, _)| !matches!(class, Class::Move | Class::Octet)).map(|(_, count)| count).sum()
    }

    /// The counts with their classes, in order.
    pub fn iter(&self) -> impl Iterator<Item = (Class, u64)> + '_ {
        Class::ALL.iter().map(|&class| (class, self[class]))
    }
}

impl Index<Class> for Counts {
    type Output = u64;
    fn index(&self, class: Class) -> &u64 {
        &self.0[class as usize]
    }
}

impl IndexMut<Class> for Counts {
    fn index_mut(&mut self, class: Class) -> &mut u64 {
        &mut self.0[class as usize]
    }
}

impl AddAssign for Counts {
    #[inline]
    fn add_assign(&mut self, other: Counts) {
        for (count, more) in self.0.iter_mut().zip(other.0) {
            *count += more;
        }
    }
}

impl Add for Counts {
    type Output = Counts;
    #[inline]
    fn add(mut self, other: Counts) -> Counts {
        self += other;
        self
    }
}

impl Sub for Counts {
    type Output = Counts;
    #[inline]
    fn sub(self, other: Counts) -> Counts {
        Counts(std::array::from_fn(|at| self.0[at] - other.0[at]))
    }
}
