/* The types of the other folder of generated code. */
#include "../count_ert_rtw/rtwtypes.h"
