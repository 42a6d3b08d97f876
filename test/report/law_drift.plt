load here.'/drift.gp'
