//! Opcodes that several devices have.

use crate::request::Request;

/// Opcode of a configuration.
pub(crate) const CONFIGURE: u8 = 0;
/// Opcode that sets the sampling period.
const SET_SAMPLING_PERIOD: u8 = 1;

/// Writes a new sampling period, if there is one.
pub(super) fn write_period(new_period: &mut Option<u16>, request: &mut Request) {
    if let Some(period) = new_period.take() {
        request.u8(SET_SAMPLING_PERIOD);
        request.u16(period);
    }
}
