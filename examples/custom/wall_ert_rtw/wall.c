/* Model wall: f = k d + b qd where the contact condition applies, 0 elsewhere. */
#include "wall.h"

/* External inputs (root inport signals with default storage) */
ExtU_wall_T wall_U;

/* External outputs (root outports fed by signals with default storage) */
ExtY_wall_T wall_Y;

/* Real-time model */
static RT_MODEL_wall_T wall_M_;
RT_MODEL_wall_T *const wall_M = &wall_M_;

/* Model step function */
void wall_step(void)
{
  real_T rtb_Sum;

  /* Sum: '<Root>/Sum' incorporates:
   *  Inport: '<Root>/b'
   *  Inport: '<Root>/d'
   *  Inport: '<Root>/k'
   *  Inport: '<Root>/qd'
   *  Product: '<Root>/Damper'
   *  Product: '<Root>/Spring'
   */
  rtb_Sum = wall_U.k * wall_U.d + wall_U.b * wall_U.qd;

  /* Outport: '<Root>/f' incorporates:
   *  Inport: '<Root>/c'
   *  Switch: '<Root>/Switch'
   */
  if (wall_U.c) {
    wall_Y.f = rtb_Sum;
  } else {
    wall_Y.f = 0.0;
  }
}

/* Model initialize function */
void wall_initialize(void)
{
  /* (no initialization code required) */
}

/* Model terminate function */
void wall_terminate(void)
{
  /* (no terminate code required) */
}
