//! What stands before a state's payload, so that bytes of another FMU, another version or a damaged file are refused.
//!
//! Little endian: magic `TREADBLK`, version (u32), GUID (36 bytes), length of the payload (u64), its CRC-32 (u32).

use crate::fmi::Refusal;

const MAGIC: &[u8; 8] = b"TREADBLK";
const VERSION: u32 = 1;
const HEADER: usize = 8 + 4 + 36 + 8 + 4;

/// The payload with its header.
pub(super) fn with_header(guid: &str, payload: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + payload.len());
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(guid.bytes().chain(std::iter::repeat(b' ')).take(36));
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend(crc32(payload).to_le_bytes());
    bytes.extend(payload);
    bytes
}

/// Checks that `bytes` are a state of this FMU and undamaged, and returns their payload.
pub fn payload<'a>(guid: &str, bytes: &'a [u8]) -> Result<&'a [u8], Refusal> {
    let refuse = |why: String| {
        Err(Refusal::error(format!("no usable FMU state: {why}; serialize it anew with this FMU")))
    };
    let Some((header, payload)) = bytes.split_at_checked(HEADER) else {
        return refuse(format!("{} bytes are fewer than its header has", bytes.len()));
    };
    if &header[..8] != MAGIC {
        return refuse("it does not start with TREADBLK".to_string());
    }
    let version = header[8..12].try_into().map(u32::from_le_bytes).unwrap_or_default();
    if version != VERSION {
        return refuse(format!("its version is {version}, allowed is {VERSION}"));
    }
    if &header[12..48] != guid.as_bytes() {
        let theirs = String::from_utf8_lossy(&header[12..48]);
        return refuse(format!("it comes from an FMU with GUID {theirs}, this one has {guid}"));
    }
    let length = header[48..56].try_into().map(u64::from_le_bytes).unwrap_or_default();
    if length != payload.len() as u64 {
        return refuse(format!("it announces {length} bytes and holds {}", payload.len()));
    }
    let sum = header[56..60].try_into().map(u32::from_le_bytes).unwrap_or_default();
    if sum != crc32(payload) {
        return refuse("its checksum is wrong, it is damaged".to_string());
    }
    Ok(payload)
}

/// CRC-32 as of ISO-HDLC (the one of zip and png).
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_one_of_zip() {
        // Check value of CRC-32/ISO-HDLC in the catalogue of parametrised CRC algorithms.
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
    }
}
