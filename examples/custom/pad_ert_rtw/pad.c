/* Model pad: a spring k in parallel with a spring k in series with a damper (tau 20 ms). */
#include "pad.h"

/* Model step function */
void pad_step(RT_MODEL_pad_T *const pad_M, ExtU_pad_T *pad_U, ExtY_pad_T *pad_Y)
{
  DW_pad_T *pad_DW = pad_M->dwork;
  real32_T rtb_Depth;

  /* Switch: '<Root>/Switch' incorporates:
   *  Inport: '<Root>/c'
   *  Inport: '<Root>/d'
   */
  if (pad_U->c) {
    rtb_Depth = pad_U->d;
  } else {
    rtb_Depth = 0.0F;
  }

  /* Outport: '<Root>/f' incorporates:
   *  Inport: '<Root>/k'
   *  UnitDelay: '<Root>/Strain'
   */
  pad_Y->f = (2.0F * rtb_Depth - pad_DW->Strain_DSTATE) * pad_U->k;
  if (!pad_U->c) {
    pad_Y->f = 0.0F;
  }

  /* Update for UnitDelay: '<Root>/Strain' incorporates:
   *  Inport: '<Root>/T'
   */
  pad_DW->Strain_DSTATE += pad_U->T / (pad_U->T + 0.02F) * (rtb_Depth -
    pad_DW->Strain_DSTATE);
}

/* Model initialize function */
void pad_initialize(RT_MODEL_pad_T *const pad_M, ExtU_pad_T *pad_U, ExtY_pad_T
                    *pad_Y)
{
  DW_pad_T *pad_DW = pad_M->dwork;
  (void)pad_U;
  (void)pad_Y;

  /* InitializeConditions for UnitDelay: '<Root>/Strain' */
  pad_DW->Strain_DSTATE = 0.0F;
}

/* Model terminate function */
void pad_terminate(RT_MODEL_pad_T *const pad_M)
{
  (void)pad_M;
}
