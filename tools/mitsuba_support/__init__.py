"""What tests/oracle and bench/peers share: starting Mitsuba 3, and handing it the same scene as wavecrest."""
