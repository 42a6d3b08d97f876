/* Model count: its parameters. */
#include "count.h"

/* Block parameters (default storage) */
P_count_T count_P = {
  /* Expression: 0.001
   * Referenced by: '<Root>/Gain'
   */
  0.001
};
