load here.'/work.gp'
