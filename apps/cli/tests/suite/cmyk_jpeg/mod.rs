//! A JPEG of one CMYK colour, which no encoder here writes.

/// Bytes of a baseline JPEG, `side` x `side` pixels (a multiple of 8), in Adobe's CMYK, where 255 is no ink.
pub fn cmyk_jpeg(side: u16, colour: [u8; 4]) -> Vec<u8> {
    let mut bytes = vec![0xff, 0xd8];
    segment(&mut bytes, 0xee, b"Adobe\x00\x64\x00\x00\x00\x00\x00");
    // Every coefficient is in steps of 8, so that the first one is the level itself.
    segment(&mut bytes, 0xdb, &[&[0][..], &[8; 64]].concat());
    let [high, low] = side.to_be_bytes();
    let components: Vec<u8> = (1..=4).flat_map(|id| [id, 0x11, 0]).collect();
    segment(&mut bytes, 0xc0, &[&[8, high, low, high, low, 4][..], &components].concat());
    // First coefficients: the 9 sizes from 0 to 8 as codes of 4 bits. Others: only "end of block", one bit.
    let sizes: Vec<u8> = (0..9).collect();
    segment(&mut bytes, 0xc4, &[&[0x00, 0, 0, 0, 9][..], &[0; 12], &sizes].concat());
    segment(&mut bytes, 0xc4, &[&[0x10, 1][..], &[0; 15], &[0]].concat());
    let components: Vec<u8> = (1..=4).flat_map(|id| [id, 0x00]).collect();
    segment(&mut bytes, 0xda, &[&[4][..], &components, &[0, 63, 0]].concat());
    let mut bits = Vec::new();
    for block in 0..usize::from(side / 8).pow(2) {
        for level in colour {
            // Blocks after the first differ from it by nothing.
            let step = if block == 0 { i32::from(level) - 128 } else { 0 };
            push_difference(&mut bits, step);
        }
    }
    bits.resize(bits.len().next_multiple_of(8), true);
    for chunk in bits.chunks(8) {
        let byte = chunk.iter().fold(0u8, |byte, bit| byte << 1 | u8::from(*bit));
        bytes.push(byte);
        if byte == 0xff {
            bytes.push(0);
        }
    }
    bytes.extend([0xff, 0xd9]);
    bytes
}

fn segment(bytes: &mut Vec<u8>, marker: u8, content: &[u8]) {
    bytes.extend([0xff, marker]);
    bytes.extend((content.len() as u16 + 2).to_be_bytes());
    bytes.extend(content);
}

/// A difference of first coefficients with its end of block.
fn push_difference(bits: &mut Vec<bool>, difference: i32) {
    let size = 32 - difference.unsigned_abs().leading_zeros();
    // A negative one is written as the bits of one less.
    let value = if difference < 0 { difference - 1 } else { difference };
    bits.extend((0..4).rev().map(|bit| size >> bit & 1 == 1));
    bits.extend((0..size).rev().map(|bit| value >> bit & 1 == 1));
    bits.push(false);
}
