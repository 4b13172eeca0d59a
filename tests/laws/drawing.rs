//! Words read off the drawn bit patterns alone: the model that encoder and decoder are compared with.

use isa::InstructionDef;

/// A row's bit pattern, character by character.
pub struct Drawing<'a> {
    /// The row.
    pub row: &'a InstructionDef,
    /// The 32 characters, from the lowest bit up.
    pub bits: Vec<char>,
    /// Bits of each operand's field, from the lowest up.
    fields: Vec<Vec<usize>>,
}

impl<'a> Drawing<'a> {
    /// The drawing of a row.
    pub fn new(row: &'a InstructionDef) -> Drawing<'a> {
        let bits: Vec<char> = row.drawn.chars().rev().filter(|&c| c != ' ').collect();
        assert_eq!(bits.len(), 32, "{}", row.name);
        let places = |letter: u8| (0..32).filter(|&place| bits[place] == letter as char).collect();
        let fields = row.operands.iter().map(|operand| places(operand.letter)).collect();
        Drawing { row, bits, fields }
    }

    /// Least and largest number of each operand's field.
    pub fn ranges(&self) -> Vec<(i64, i64)> {
        let operands = self.row.operands.iter().zip(&self.fields);
        operands.map(|(operand, field)| operand.kind.range(field.len() as u8)).collect()
    }

    /// Count of the numbers that an operand's field could tell apart.
    pub fn values(&self, operand: usize) -> i64 {
        1 << self.fields[operand].len()
    }

    /// The word that the bit pattern shows when each letter stands for its operand's bits.
    pub fn word(&self, operands: &[i64]) -> u32 {
        let fixed = (0..32).filter(|&place| self.bits[place] == '1').fold(0, |word, place| word | 1 << place);
        self.fields.iter().zip(operands).fold(fixed, |word, (field, &value)| {
            field.iter().enumerate().fold(word, |word, (bit, &place)| word | ((value >> bit & 1) as u32) << place)
        })
    }

    /// True where a word has all the fixed bits.
    pub fn matches(&self, word: u32) -> bool {
        self.bits.iter().enumerate().all(|(place, c)| match c {
            '0' | '-' => word >> place & 1 == 0,
            '1' => word >> place & 1 == 1,
            _ => true,
        })
    }

    /// True where the unsigned field of an operand holds, in a word, a number beyond the operand's range.
    pub fn is_beyond(&self, word: u32) -> bool {
        self.fields.iter().zip(self.ranges()).zip(self.row.operands.iter()).any(|((field, (_, most)), operand)| {
            let value: i64 = field.iter().enumerate().map(|(bit, &place)| i64::from(word >> place & 1) << bit).sum();
            !operand.kind.is_signed() && value > most
        })
    }
}

/// The drawings of all built-in rows, in the order of the table.
pub fn all() -> Vec<Drawing<'static>> {
    isa::INSTRUCTIONS.iter().map(Drawing::new).collect()
}
