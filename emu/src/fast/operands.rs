//! How the rows of [`super::rows`] read and write the lanes of a group: by lane, or all at once.

/// Copies the lanes of an operand, so that what is written cannot change what is still to be read.
macro_rules! copy {
    ($lanes:expr, $fields:expr, $letter:ident S) => {
        *$lanes.scalar($fields.$letter)
    };
    ($lanes:expr, $fields:expr, $letter:ident A) => {
        *$lanes.scalar($fields.$letter)
    };
    ($lanes:expr, $fields:expr, $letter:ident V) => {
        *$lanes.vector($fields.$letter)
    };
    ($lanes:expr, $fields:expr, $letter:ident W) => {
        *$lanes.wide($fields.$letter)
    };
    ($lanes:expr, $fields:expr, $letter:ident W3) => {{
        let number = $fields.$letter;
        [*$lanes.wide(number), *$lanes.wide(number.wrapping_add(1)), *$lanes.wide(number.wrapping_add(2))]
    }};
    ($lanes:expr, $fields:expr, $letter:ident $immediate:ident) => {
        $fields.$letter
    };
}

/// The value of one lane of such a copy.
macro_rules! pick {
    ($lane:ident, $letter:ident S) => {
        $letter[$lane]
    };
    ($lane:ident, $letter:ident A) => {
        $letter[$lane] as u32
    };
    ($lane:ident, $letter:ident V) => {
        [$letter[0][$lane], $letter[1][$lane], $letter[2][$lane]]
    };
    ($lane:ident, $letter:ident W) => {
        $letter[$lane]
    };
    ($lane:ident, $letter:ident W3) => {
        [$letter[0][$lane], $letter[1][$lane], $letter[2][$lane]]
    };
    ($lane:ident, $letter:ident $immediate:ident) => {
        $letter
    };
}

/// Keeps what was computed for a lane if the lane executes.
macro_rules! blend {
    ($lanes:expr, $fields:expr, $lane:ident $is_on:ident, $letter:ident S) => {{
        let place = &mut $lanes.scalar_mut($fields.$letter)[$lane];
        *place = if $is_on { $letter } else { *place };
    }};
    ($lanes:expr, $fields:expr, $lane:ident $is_on:ident, $letter:ident V) => {
        for k in 0..3 {
            let place = &mut $lanes.vector_mut($fields.$letter)[k][$lane];
            *place = if $is_on { $letter[k] } else { *place };
        }
    };
    ($lanes:expr, $fields:expr, $lane:ident $is_on:ident, $letter:ident W) => {{
        let place = &mut $lanes.wide_mut($fields.$letter)[$lane];
        *place = if $is_on { $letter } else { *place };
    }};
    ($lanes:expr, $fields:expr, $lane:ident $is_on:ident, $letter:ident W3) => {
        for k in 0..3 {
            let place = &mut $lanes.wide_mut($fields.$letter.wrapping_add(k as u8))[$lane];
            *place = if $is_on { $letter[k] } else { *place };
        }
    };
}

/// The value of an operand in one lane.
macro_rules! get {
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident S) => {
        $lanes.scalar($fields.$letter)[$lane]
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident A) => {
        $lanes.scalar($fields.$letter)[$lane] as u32
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident V) => {{
        let vector = $lanes.vector($fields.$letter);
        [vector[0][$lane], vector[1][$lane], vector[2][$lane]]
    }};
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident W) => {
        $lanes.wide($fields.$letter)[$lane]
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident V2) => {
        $lanes.vectors::<2>($fields.$letter, $lane)
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident V3) => {
        $lanes.vectors::<3>($fields.$letter, $lane)
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident V5) => {
        $lanes.vectors::<5>($fields.$letter, $lane)
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident W3) => {
        $lanes.wides3($fields.$letter, $lane)
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident $immediate:ident) => {
        $fields.$letter
    };
}

/// Puts a value where a written operand of one lane says; scalar 0 is cleared by [`clear_zero`].
macro_rules! set {
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident S) => {
        $lanes.scalar_mut($fields.$letter)[$lane] = $letter
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident V) => {
        $lanes.set_vectors($fields.$letter, $lane, [$letter])
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident W) => {
        $lanes.wide_mut($fields.$letter)[$lane] = $letter
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident W3) => {
        $lanes.set_wides3($fields.$letter, $lane, $letter)
    };
    ($lanes:expr, $fields:expr, $lane:ident, $letter:ident $vectors:ident) => {
        $lanes.set_vectors($fields.$letter, $lane, $letter)
    };
}

/// Scalar 0 stays zero.
macro_rules! clear_zero {
    ($lanes:expr, $letter:ident S) => {
        *$lanes.scalar_mut(0) = [0; LANES]
    };
    ($lanes:expr, $letter:ident $kind:ident) => {};
}

/// Writes what a meaning handed back for one lane, and yields the exit.
macro_rules! finish {
    ($lanes:expr, $fields:expr, $lane:ident, $result:expr, []) => {
        $result
    };
    ($lanes:expr, $fields:expr, $lane:ident, $result:expr, [$(($letter:ident $kind:ident))+]) => {{
        let ($($letter,)+ exit) = $result;
        $(set!($lanes, $fields, $lane, $letter $kind);)+
        exit
    }};
}

/// Keeps what a control row wrote for a lane that executes, and yields the exit.
macro_rules! keep {
    ($lanes:expr, $fields:expr, $lane:ident $is_on:ident, $result:expr, []) => {{
        let _ = $is_on;
        $result
    }};
    ($lanes:expr, $fields:expr, $lane:ident $is_on:ident, $result:expr, [$(($letter:ident $kind:ident))+]) => {{
        let ($($letter,)+ exit) = $result;
        $(blend!($lanes, $fields, $lane $is_on, $letter $kind);)+
        exit
    }};
}

/// Writes what a meaning handed back for all lanes that execute.
macro_rules! spread {
    ($lanes:expr, $fields:expr, $mask:expr, $result:expr, []) => {{
        let _ = $result;
    }};
    ($lanes:expr, $fields:expr, $mask:expr, $result:expr, [$(($letter:ident $kind:ident))+]) => {{
        let ($($letter,)+ _) = $result;
        $(spread!($lanes, $fields, $mask, $letter $kind);)+
    }};
    ($lanes:expr, $fields:expr, $mask:expr, $letter:ident S) => {
        fill($lanes.scalar_mut($fields.$letter), $mask, $letter)
    };
    ($lanes:expr, $fields:expr, $mask:expr, $letter:ident W) => {
        fill($lanes.wide_mut($fields.$letter), $mask, $letter)
    };
    ($lanes:expr, $fields:expr, $mask:expr, $letter:ident $vectors:ident) => {
        for (at, vector) in $letter.into_iter().enumerate() {
            for (row, value) in $lanes.vector_mut($fields.$letter.wrapping_add(at as u8)).iter_mut().zip(vector) {
                fill(row, $mask, value);
            }
        }
    };
}

pub(super) use {blend, clear_zero, copy, finish, get, keep, pick, set, spread};
