/* Model wall: a spring and a damper, in floats; interface: nonreusable function. */
#ifndef RTW_HEADER_wall_h_
#define RTW_HEADER_wall_h_
#include "rtwtypes.h"
#include "wall_types.h"

/* Macros for accessing real-time model data structure */
#ifndef rtmGetErrorStatus
#define rtmGetErrorStatus(rtm)         ((rtm)->errorStatus)
#endif

#ifndef rtmSetErrorStatus
#define rtmSetErrorStatus(rtm, val)    ((rtm)->errorStatus = (val))
#endif

/* External inputs (root inport signals with default storage) */
typedef struct {
  real_T d;                            /* '<Root>/d' */
  real_T qd;                           /* '<Root>/qd' */
  boolean_T c;                         /* '<Root>/c' */
  real_T k;                            /* '<Root>/k' */
  real_T b;                            /* '<Root>/b' */
} ExtU_wall_T;

/* External outputs (root outports fed by signals with default storage) */
typedef struct {
  real_T f;                            /* '<Root>/f' */
} ExtY_wall_T;

/* Real-time Model Data Structure */
struct tag_RTM_wall_T {
  const char_T * volatile errorStatus;
};

/* External inputs (root inport signals with default storage) */
extern ExtU_wall_T wall_U;

/* External outputs (root outports fed by signals with default storage) */
extern ExtY_wall_T wall_Y;

/* Model entry point functions */
extern void wall_initialize(void);
extern void wall_step(void);
extern void wall_terminate(void);

/* Real-time Model object */
extern RT_MODEL_wall_T *const wall_M;

#endif
