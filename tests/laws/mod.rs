//! Laws of every row of the table, read off the table: how it is written as a word and as text, and that it
//! costs what it is made of. Nothing here names a row.

mod composite;
mod drawing;
mod encoding;
mod random;
mod text;
