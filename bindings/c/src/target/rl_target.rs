//! Actions of policies.

use opendr::target::RlTarget;

use crate::handle::Out;
use crate::pointer::{place, slice};
use crate::status::{guard, opendr_status};
use crate::target::check_finite;
use crate::value::{AnyValue, opendr_rl_target};

/// Creates an action from count numbers, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_rl_target_create(
    values: *const f32,
    count: usize,
    target: *mut *mut opendr_rl_target,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, values) = unsafe { (Out::new(target, "target")?, slice(values, count, "values")?) };
        check_finite(values, "an action")?;
        out.set(AnyValue::from(RlTarget::from(values.to_vec())));
        Ok(())
    })
}

/// Writes a pointer to the numbers of an action as a flat array in the order of the action space, valid as long as the action.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_rl_target_read(
    target: *const opendr_rl_target,
    values: *mut *const f32,
    count: *mut usize,
) -> opendr_status {
    guard(|| {
        let (values, count) = (place(values, "values")?, place(count, "count")?);
        // SAFETY: the rules at the top of opendr.h.
        unsafe {
            let target: &RlTarget = AnyValue::of(target, "target")?.typed("target")?;
            values.write(target.values.as_ptr());
            count.write(target.values.len());
        }
        Ok(())
    })
}
