//! Splits the operands of a row into those that a meaning reads and those that it writes, at compile time.

/// Calls `$then! { $state [read operands] [written operands] }`, each operand as `(letter Kind)` in the row's order.
///
/// Letters: `d e` written, `x y` read and written, anything else read.
macro_rules! split_operands {
    ($then:ident $state:tt $read:tt $written:tt ()) => { $then! { $state $read $written } };
    ($then:ident $state:tt $read:tt [$($written:tt)*] (d: $kind:ident $(, $($rest:tt)*)?)) => {
        $crate::semantics::split_operands! { $then $state $read [$($written)* (d $kind)] ($($($rest)*)?) }
    };
    ($then:ident $state:tt $read:tt [$($written:tt)*] (e: $kind:ident $(, $($rest:tt)*)?)) => {
        $crate::semantics::split_operands! { $then $state $read [$($written)* (e $kind)] ($($($rest)*)?) }
    };
    ($then:ident $state:tt [$($read:tt)*] [$($written:tt)*] (x: $kind:ident $(, $($rest:tt)*)?)) => {
        $crate::semantics::split_operands! { $then $state [$($read)* (x $kind)] [$($written)* (x $kind)] ($($($rest)*)?) }
    };
    ($then:ident $state:tt [$($read:tt)*] [$($written:tt)*] (y: $kind:ident $(, $($rest:tt)*)?)) => {
        $crate::semantics::split_operands! { $then $state [$($read)* (y $kind)] [$($written)* (y $kind)] ($($($rest)*)?) }
    };
    ($then:ident $state:tt [$($read:tt)*] $written:tt ($letter:ident: $kind:ident $(, $($rest:tt)*)?)) => {
        $crate::semantics::split_operands! { $then $state [$($read)* ($letter $kind)] $written ($($($rest)*)?) }
    };
}

pub(crate) use split_operands;
