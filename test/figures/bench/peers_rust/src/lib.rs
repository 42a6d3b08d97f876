//! 22 channels of each filter; coefficients from C.

use dsp_fixedpoint::Q;
use dsp_process::SplitProcess;
use idsp::iir::{Biquad, DirectForm1, DirectForm1Dither, DirectForm1Wide};
use idsp::{Lowpass, LowpassState};

const CHANNELS: usize = 22;

type Section = Biquad<Q<i32, i64, 30>>;

struct Channel<C, S> {
    coeff: C,
    state: S,
}

/// start(coefficients of 30 fraction bits), one sample of channel 0, one of all channels.
macro_rules! biquad {
    ($state:ty, $cell:ident, $start:ident, $step:ident, $tick:ident) => {
        static mut $cell: Vec<Channel<Section, $state>> = Vec::new();

        /// # Safety
        /// Five values at `ba`; one thread.
        #[no_mangle]
        pub unsafe extern "C" fn $start(ba: *const i32) {
            let ba = std::slice::from_raw_parts(ba, 5);
            let coeff = Section { ba: std::array::from_fn(|i| Q::from_bits(ba[i])) };
            let all = &mut *std::ptr::addr_of_mut!($cell);
            all.clear();
            for _ in 0..CHANNELS {
                all.push(Channel { coeff: coeff.clone(), state: Default::default() });
            }
        }

        /// # Safety
        /// Started; one thread.
        #[no_mangle]
        pub unsafe extern "C" fn $step(x: i32) -> i32 {
            let c = &mut (&mut *std::ptr::addr_of_mut!($cell))[0];
            c.coeff.process(&mut c.state, x)
        }

        /// # Safety
        /// Started; 22 values at each; one thread.
        #[no_mangle]
        pub unsafe extern "C" fn $tick(x: *const i32, y: *mut i32) {
            let x = std::slice::from_raw_parts(x, CHANNELS);
            let y = std::slice::from_raw_parts_mut(y, CHANNELS);
            let all = &mut *std::ptr::addr_of_mut!($cell);
            for ((c, x), y) in all.iter_mut().zip(x).zip(y) {
                *y = c.coeff.process(&mut c.state, *x);
            }
        }
    };
}

biquad!(DirectForm1<i32>, DF1, idsp_df1_start, idsp_df1_step, idsp_df1_tick);
biquad!(DirectForm1Wide, WIDE, idsp_wide_start, idsp_wide_step, idsp_wide_tick);
biquad!(DirectForm1Dither, DITHER, idsp_dither_start, idsp_dither_step, idsp_dither_tick);

static mut LOWPASS: Vec<Channel<Lowpass<2>, LowpassState<2>>> = Vec::new();

/// # Safety
/// Two values at `k`; one thread.
#[no_mangle]
pub unsafe extern "C" fn idsp_lowpass_start(k: *const i32) {
    let k = std::slice::from_raw_parts(k, 2);
    let all = &mut *std::ptr::addr_of_mut!(LOWPASS);
    all.clear();
    for _ in 0..CHANNELS {
        all.push(Channel { coeff: Lowpass([k[0], k[1]]), state: Default::default() });
    }
}

/// # Safety
/// Started; one thread.
#[no_mangle]
pub unsafe extern "C" fn idsp_lowpass_step(x: i32) -> i32 {
    let c = &mut (&mut *std::ptr::addr_of_mut!(LOWPASS))[0];
    c.coeff.process(&mut c.state, x)
}

/// # Safety
/// Started; 22 values at each; one thread.
#[no_mangle]
pub unsafe extern "C" fn idsp_lowpass_tick(x: *const i32, y: *mut i32) {
    let x = std::slice::from_raw_parts(x, CHANNELS);
    let y = std::slice::from_raw_parts_mut(y, CHANNELS);
    let all = &mut *std::ptr::addr_of_mut!(LOWPASS);
    for ((c, x), y) in all.iter_mut().zip(x).zip(y) {
        *y = c.coeff.process(&mut c.state, *x);
    }
}

/// Both of an angle, 2^32 a turn.
///
/// # Safety
/// Two places.
#[no_mangle]
pub unsafe extern "C" fn idsp_sine(turn: i32, cosine: *mut i32, sine: *mut i32) {
    let (c, s) = idsp::cossin(turn);
    *cosine = c;
    *sine = s;
}
