//! Activity of a program: operations by class and width, and bits that moved, from the rows of the table and how often each ended which way.

use emu::code::{Code, PassRows};
use emu::tally::Tally;
use isa::{Class, Counts, InstructionDef, Isa, Kind};

/// Bits of integers, addresses and words of the buffer, whatever the word length.
pub const INTEGER_BITS: u32 = 32;

/// Rooms of the table whose scalars are integers or addresses.
const INTEGER_ROOMS: [&str; 4] = ["integer", "local", "bus", "control"];

/// Width of the numbers that an operation works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Integers and addresses.
    Integer,
    /// Numbers of a word.
    Word,
    /// Accumulators, twice a word.
    Double,
}

impl Width {
    /// Every width.
    pub const ALL: [Width; 3] = [Width::Integer, Width::Word, Width::Double];

    /// Bits on words of so many bits.
    pub const fn bits(self, word: u32) -> u32 {
        match self {
            Width::Integer => INTEGER_BITS,
            Width::Word => word,
            Width::Double => 2 * word,
        }
    }

    /// Width of the operations of a row: that of accumulators where it reads nothing else, of integers in the rooms of integers, else of the word.
    pub fn of(row: &InstructionDef) -> Width {
        let mut reads = row.operands.iter().filter(|operand| operand.is_read()).peekable();
        let reads_something = reads.peek().is_some();
        if reads_something && reads.all(|operand| matches!(operand.kind, Kind::W | Kind::W3)) {
            Width::Double
        } else if INTEGER_ROOMS.contains(&&*row.room) {
            Width::Integer
        } else {
            Width::Word
        }
    }
}

/// Operations and bits that moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Activity {
    /// Operations by class and width.
    pub operations: [[u64; Width::ALL.len()]; Class::ALL.len()],
    /// Bits of registers that instructions read or wrote.
    pub register_bits: u64,
    /// Bits of buffers that were read or written.
    pub buffer_bits: u64,
    /// Octets of global memory that instructions asked for.
    pub memory_octets: u64,
    /// Octets of messages.
    pub message_octets: u64,
}

impl Activity {
    /// Adds another activity some times.
    pub fn add(&mut self, more: &Activity, times: u64) {
        for (mine, more) in self.operations.as_flattened_mut().iter_mut().zip(more.operations.as_flattened()) {
            *mine += more * times;
        }
        self.register_bits += more.register_bits * times;
        self.buffer_bits += more.buffer_bits * times;
        self.memory_octets += more.memory_octets * times;
        self.message_octets += more.message_octets * times;
    }

    /// Adds the operations of a row's outcome. `is_each` says that they are those of a unit, such as an octet of a block.
    fn add_counts(&mut self, row: &InstructionDef, counts: &Counts, is_each: bool) {
        let width = Width::of(row);
        for (class, count) in counts.iter() {
            // Words of the buffer and octets are counted in bits; a request costs nothing by itself.
            let width = if class == Class::Address { Width::Integer } else { width };
            if !matches!(class, Class::Local | Class::Octet | Class::Mem) {
                self.operations[class as usize][width as usize] += count;
            }
        }
        self.buffer_bits += counts[Class::Local] * u64::from(INTEGER_BITS);
        // Octets without an address are those of a message; octets of a block go through the buffer, where the second address is.
        let octets = counts[Class::Octet];
        let addresses = row.operands.iter().filter(|operand| operand.kind == Kind::A).count();
        match addresses {
            0 => self.message_octets += octets,
            _ => self.memory_octets += octets,
        }
        if is_each && addresses == 2 {
            self.buffer_bits += 8 * octets;
        }
    }
}

/// Bits of registers that an instruction of a row reads and writes.
fn register_bits(row: &InstructionDef, word: u32) -> u64 {
    let bits = |kind: Kind| -> u32 {
        let registers = u32::from(kind.registers());
        match kind.register_file() {
            None => 0,
            Some('v') => registers * 3 * word,
            Some('w') => registers * 2 * word,
            Some(_) if kind == Kind::A || INTEGER_ROOMS.contains(&&*row.room) => INTEGER_BITS,
            Some(_) => word,
        }
    };
    let times = |is: bool| u64::from(is);
    row.operands.iter().map(|one| u64::from(bits(one.kind)) * (times(one.is_read()) + times(one.is_written()))).sum()
}

/// Activity of a pass, and what each of its units adds, on words of so many bits.
pub fn of_pass(isa: &Isa, rows: &PassRows, word: u32) -> (Activity, Activity) {
    let (mut once, mut each) = (Activity::default(), Activity::default());
    if let Some((op, outcome)) = rows.counted {
        let row = isa.definition(op);
        let outcome = &row.outcomes[usize::from(outcome)];
        once.add_counts(row, &outcome.cost, false);
        each.add_counts(row, &outcome.each, true);
    }
    if let Some(op) = rows.instruction {
        once.register_bits += register_bits(isa.definition(op), word);
    }
    (once, each)
}

/// Activity of each region of a program, by its number, and of what is in none, last.
pub fn by_region(code: &Code, tally: &Tally, word: u32) -> Vec<Activity> {
    let regions = code.program.regions.len();
    let mut found = vec![Activity::default(); regions + 1];
    for (number, passes) in tally.all().iter().enumerate().filter(|(_, passes)| passes.count != 0 || passes.units != 0)
    {
        let rows = code.pass_rows(number);
        let region = code.program.region_of.get(rows.word as usize).copied().flatten();
        let region = region.map_or(regions, |region| usize::from(region).min(regions));
        let (once, each) = of_pass(code.isa, &rows, word);
        found[region].add(&once, passes.count);
        found[region].add(&each, passes.units);
    }
    found
}

#[cfg(test)]
mod tests {
    use isa::Isa;

    use super::*;

    fn row(name: &str) -> InstructionDef {
        let found = isa::INSTRUCTIONS.iter().find(|row| row.name == name);
        found.unwrap_or_else(|| panic!("there is no {name}")).clone()
    }

    #[test]
    fn operations_are_as_wide_as_what_rows_read() {
        for (name, width) in [
            ("add", Width::Word),
            ("iadd", Width::Integer),
            ("beq", Width::Integer),
            ("bweqz", Width::Double),
            ("wadd", Width::Double),
            ("wmac", Width::Word),
            ("wmul", Width::Word),
            ("wdiv", Width::Double),
            ("vdot", Width::Word),
            ("rtri", Width::Word),
            ("fetchadd", Width::Integer),
        ] {
            assert_eq!(Width::of(&row(name)), width, "{name}");
        }
        let rooms: Vec<&str> = isa::table::ROOMS.iter().map(|room| room.name).collect();
        assert!(INTEGER_ROOMS.iter().all(|room| rooms.contains(room)), "{rooms:?}");
    }

    #[test]
    fn registers_count_what_is_read_and_written() {
        // On words of 20 bits: three scalars; three vectors of three; an accumulator of 40 read and written with two scalars; an address.
        for (name, bits) in [("add", 60), ("vadd", 180), ("wmac", 80 + 40), ("iadd", 96), ("lv", 60 + 32), ("halt", 0)]
        {
            assert_eq!(register_bits(&row(name), 20), bits, "{name}");
        }
    }

    #[test]
    fn octets_without_an_address_are_messages() {
        let isa = Isa::base();
        for (name, memory, messages, buffer) in [
            ("load", 1, 0, 8),
            ("store", 1, 0, 8),
            ("ldw", 4, 0, 0),
            ("send5", 0, 60, 0),
            ("lv", 0, 0, 96),
            ("lwp", 0, 0, 32),
        ] {
            let op = isa::Op::BUILT_IN.iter().copied().find(|&op| isa.definition(op).name == name).unwrap();
            let (mut all, each) = of_pass(&isa, &PassRows { word: 0, counted: Some((op, 0)), instruction: None }, 32);
            all.add(&each, 1);
            assert_eq!((all.memory_octets, all.message_octets, all.buffer_bits), (memory, messages, buffer), "{name}");
        }
    }
}
