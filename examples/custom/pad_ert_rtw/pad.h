/* Model pad: a soft pad, viscous as foam is, in single precision; interface: reusable function, root-level
 * I/O by structure reference. */
#ifndef RTW_HEADER_pad_h_
#define RTW_HEADER_pad_h_
#include "rtwtypes.h"
#include "pad_types.h"

/* Block states (default storage) for system '<Root>' */
typedef struct {
  real32_T Strain_DSTATE;              /* '<Root>/Strain' */
} DW_pad_T;

/* External inputs (root inport signals with default storage) */
typedef struct {
  real32_T d;                          /* '<Root>/d' */
  boolean_T c;                         /* '<Root>/c' */
  real32_T k;                          /* '<Root>/k' */
  real32_T T;                          /* '<Root>/T' */
} ExtU_pad_T;

/* External outputs (root outports fed by signals with default storage) */
typedef struct {
  real32_T f;                          /* '<Root>/f' */
} ExtY_pad_T;

/* Real-time Model Data Structure */
struct tag_RTM_pad_T {
  const char_T * volatile errorStatus;
  DW_pad_T *dwork;
};

/* Model entry point functions */
extern void pad_initialize(RT_MODEL_pad_T *const pad_M, ExtU_pad_T *pad_U,
  ExtY_pad_T *pad_Y);
extern void pad_step(RT_MODEL_pad_T *const pad_M, ExtU_pad_T *pad_U, ExtY_pad_T *
                     pad_Y);
extern void pad_terminate(RT_MODEL_pad_T *const pad_M);

#endif
