/* Model count: 1 mN more a step. */
#include "count.h"

/* Model step function */
void count_step(RT_MODEL_count_T *const count_M)
{
  P_count_T *count_P_0 = ((P_count_T *) count_M->defaultParam);
  DW_count_T *count_DW = count_M->dwork;
  ExtU_count_T *count_U = (ExtU_count_T *) count_M->inputs;
  ExtY_count_T *count_Y = (ExtY_count_T *) count_M->outputs;

  /* Outport: '<Root>/steps' */
  count_Y->steps = count_U->t;

  /* Outport: '<Root>/pull' incorporates:
   *  Gain: '<Root>/Gain'
   *  UnitDelay: '<Root>/Unit Delay'
   */
  count_Y->pull = count_P_0->Gain_Gain * count_DW->UnitDelay_DSTATE;

  /* Update for UnitDelay: '<Root>/Unit Delay' */
  count_DW->UnitDelay_DSTATE++;
}

/* Model initialize function */
void count_initialize(RT_MODEL_count_T *const count_M)
{
  DW_count_T *count_DW = count_M->dwork;

  /* InitializeConditions for UnitDelay: '<Root>/Unit Delay' */
  count_DW->UnitDelay_DSTATE = 7.0;
}

/* Model terminate function */
void count_terminate(RT_MODEL_count_T *const count_M)
{
  count_M->dwork->UnitDelay_DSTATE = -1.0;
}
