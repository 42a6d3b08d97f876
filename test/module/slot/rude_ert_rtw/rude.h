/* Model rude: answers that no controller should give, by input k; interface: reusable function, root-level
 * I/O by individual arguments. */
#ifndef RTW_HEADER_rude_h_
#define RTW_HEADER_rude_h_
#include "rtwtypes.h"

/* Forward declaration for rtModel */
typedef struct tag_RTM_rude_T RT_MODEL_rude_T;

/* Real-time Model Data Structure */
struct tag_RTM_rude_T {
  const char_T * volatile errorStatus;
};

/* Model entry point functions */
extern void rude_initialize(RT_MODEL_rude_T *const rude_M);
extern void rude_step(RT_MODEL_rude_T *const rude_M, real_T rude_U_k, boolean_T
                      rude_U_c, real_T rude_U_t, real_T *rude_Y_f);
extern void rude_terminate(RT_MODEL_rude_T *const rude_M);

#endif
