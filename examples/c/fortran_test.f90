! An element as a finite-element code calls it: its state variables in, a trial, its force, stiffness and state out.
program fortran_test
    use stickslip
    implicit none
    integer(c_size_t), parameter :: kept = 6
    character(len=*), parameter :: ball = '{"profile": {"type": "sphere", "radius": 0.01}, ' // &
        '"material": {"effective": {"e_star": 1.15e11, "g_star": 8.5e10}}, ' // &
        '"friction": 0.3, "preload": {"normal_force": 10.0}}' // c_null_char
    type(c_ptr) :: contact, reference
    real(c_double) :: state(2*kept + 4), to(1), forces(2), expected(2), stiffness(2)
    integer(c_int) :: dropped
    integer :: i

    call check(ss_contact_new(ball, contact))
    call check(ss_contact_new(ball, reference))
    call check(ss_packed_fixed(contact, kept, state, dropped))
    do i = 1, 200
        to(1) = 4d-8*sin(0.1d0*i)
        call check(ss_unpack_fixed(contact, kept, state))
        call check(ss_trial(contact, ss_constant_load, 0d0, to, forces))
        call check(ss_stiffness(contact, 1_c_int, stiffness))
        call check(ss_commit(contact))
        call check(ss_packed_fixed(contact, kept, state, dropped))
        call check(ss_step(reference, ss_constant_load, 0d0, to, expected))
        if (dropped /= 0 .or. any(abs(forces - expected) > 1d-11*expected(1)) .or. stiffness(2) <= 0d0) stop 1
    end do
    call check(ss_free(contact))
    call check(ss_free(reference))
    print '(a)', 'fortran: ok'

contains

    subroutine check(code)
        integer(c_int), intent(in) :: code
        if (code /= ss_ok) stop 2
    end subroutine
end program
