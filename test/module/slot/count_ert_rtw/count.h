/* Model count: a force that counts its steps; interface: reusable function, root-level I/O part of the model
 * data structure. */
#ifndef RTW_HEADER_count_h_
#define RTW_HEADER_count_h_
#include "rtwtypes.h"

/* Forward declaration for rtModel */
typedef struct tag_RTM_count_T RT_MODEL_count_T;

/* Block states (default storage) for system '<Root>' */
typedef struct {
  real_T UnitDelay_DSTATE;             /* '<Root>/Unit Delay' */
} DW_count_T;

/* External inputs (root inport signals with default storage) */
typedef struct {
  real_T position;                     /* '<Root>/position' */
  real32_T t;                          /* '<Root>/t' */
  int32_T on;                          /* '<Root>/on' */
} ExtU_count_T;

/* External outputs (root outports fed by signals with default storage) */
typedef struct {
  real_T steps;                        /* '<Root>/steps' */
  real_T pull;                         /* '<Root>/pull' */
} ExtY_count_T;

/* Parameters (default storage) */
struct P_count_T_ {
  real_T Gain_Gain;                    /* Expression: 0.001
                                        * Referenced by: '<Root>/Gain'
                                        */
};

/* Parameters (default storage) */
typedef struct P_count_T_ P_count_T;

/* Real-time Model Data Structure */
struct tag_RTM_count_T {
  const char_T * volatile errorStatus;
  P_count_T *defaultParam;
  ExtU_count_T *inputs;
  ExtY_count_T *outputs;
  DW_count_T *dwork;
};

/* Block parameters (default storage) */
extern P_count_T count_P;

/* Model entry point functions */
extern void count_initialize(RT_MODEL_count_T *const count_M);
extern void count_step(RT_MODEL_count_T *const count_M);
extern void count_terminate(RT_MODEL_count_T *const count_M);

#endif
