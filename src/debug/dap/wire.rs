//! Messages of the Debug Adapter Protocol on a stream: a head with the length, then JSON.

use std::io::{self, BufRead, Read, Write};

use serde_json::Value;

/// Octets of the longest message that is read.
const LONGEST: u64 = 16 << 20;

fn wrong(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what.to_owned())
}

/// The next message; `None` at the end of the stream.
///
/// # Errors
/// A head without a length, a message that is too long, and what is no JSON.
pub fn read(input: &mut dyn BufRead) -> io::Result<Option<Value>> {
    let mut length = None;
    loop {
        let mut line = String::new();
        // A head has a few short lines; a stream without line ends is none.
        if (&mut *input).take(1024).read_line(&mut line)? == 0 {
            return if length.is_none() { Ok(None) } else { Err(wrong("the stream ends in a head")) };
        }
        let line = line.trim_end();
        if line.is_empty() {
            break;
        }
        if let Some((name, value)) = line.split_once(':')
            && name.eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse::<u64>().ok();
        }
    }
    let length = length.ok_or_else(|| wrong("a head without Content-Length"))?;
    if length > LONGEST {
        return Err(wrong("a message of more than 16 MiB"));
    }
    let mut octets = Vec::new();
    if input.take(length).read_to_end(&mut octets)? as u64 != length {
        return Err(wrong("the stream ends in a message"));
    }
    serde_json::from_slice(&octets).map(Some).map_err(|error| wrong(&format!("a message is no JSON: {error}")))
}

/// Writes a message.
///
/// # Errors
/// A stream that takes nothing more.
pub fn write(output: &mut dyn Write, message: &Value) -> io::Result<()> {
    let text = message.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn messages_go_there_and_back() {
        let mut stream = Vec::new();
        for message in [json!({"seq": 1, "text": "ä"}), json!([])] {
            write(&mut stream, &message).unwrap();
        }
        let mut input = stream.as_slice();
        assert_eq!(read(&mut input).unwrap(), Some(json!({"seq": 1, "text": "ä"})));
        assert_eq!(read(&mut input).unwrap(), Some(json!([])));
        assert_eq!(read(&mut input).unwrap(), None);
    }

    #[test]
    fn what_is_no_message_is_refused() {
        for text in [
            "x\r\n\r\n",
            "Content-Length: 5\r\n\r\n{}",
            "Content-Length: 99999999999\r\n\r\n",
            "Content-Length: 2\r\n\r\n{]",
            "Content-Length: 2\r\n",
        ] {
            assert!(read(&mut text.as_bytes()).is_err(), "{text:?}");
        }
    }
}
