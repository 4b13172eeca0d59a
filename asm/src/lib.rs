//! Assembler and disassembler of lancer.
