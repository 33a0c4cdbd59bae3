! SPDX-License-Identifier: LGPL-2.1-or-later
! A UMAT for the tests: J2 plasticity with linear hardening, in Kirchhoff's stress, as the program's
! hypoelastic law. PROPS: Young's modulus, Poisson's ratio, yield stress, hardening modulus. STATEV(1):
! equivalent plastic strain. CMNAME tells what goes wrong: at a plastic strain above 1 %, the library
! crashes, calls XIT or STOP, or returns numbers that are none. Others have wrong tangents or no energies,
! or write where they must not.

subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, &
    dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, &
    pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
  implicit none
  character(len=80) :: cmname
  integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
  double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, &
      ddsddt(ntens), drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, &
      predef(1), dpred(1), props(nprops), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, &
      3)
  double precision :: bulk, shear, before, after, pressure, s(6), mean, q, excess, beta, gamma, n(6), &
      mises, invariant
  integer :: i, j

  if (nprops /= 4 .or. nstatv < 1 .or. ntens /= 6) call xit
  bulk = props(1) / (3 * (1 - 2 * props(2)))
  shear = props(1) / (2 * (1 + props(2)))
  before = determinant(dfgrd0)
  after = determinant(dfgrd1)
  pressure = bulk * log(after)

  ! Trial deviator of Kirchhoff's stress, with tensor components.
  mean = sum(stress(1:3)) / 3
  s(1:3) = before * (stress(1:3) - mean) + 2 * shear * (dstran(1:3) - sum(dstran(1:3)) / 3)
  s(4:6) = before * stress(4:6) + shear * dstran(4:6)
  call sinv(s, invariant, q, ndi, nshr)
  excess = q - props(3) - props(4) * statev(1)
  beta = 1
  gamma = 0
  n = 0
  if (excess > 0) then
    excess = excess / (3 * shear + props(4))
    beta = 1 - 3 * shear * excess / q
    gamma = 1 / (1 + props(4) / (3 * shear)) - (1 - beta)
    n = sqrt(1.5d0) * s / q
    statev(1) = statev(1) + excess
  end if
  stress = beta * s / after
  stress(1:3) = stress(1:3) + pressure / after
  call sinv(stress, invariant, mises, ndi, nshr)
  sse = (mises * after)**2 / (6 * shear) + bulk * log(after)**2 / 2
  spd = props(3) * statev(1) + props(4) * statev(1)**2 / 2

  ddsdde = 0
  ddsdde(1:3, 1:3) = bulk - 2 * shear * beta / 3
  do i = 1, 6
    ddsdde(i, i) = ddsdde(i, i) + merge(2, 1, i <= 3) * shear * beta
    do j = 1, 6
      ddsdde(i, j) = ddsdde(i, j) - 2 * shear * gamma * n(i) * n(j)
    end do
  end do
  ddsdde = ddsdde / after
  if (cmname == 'WRONG TANGENT' .and. gamma > 0) ddsdde(4:6, 4:6) = 3 * ddsdde(4:6, 4:6)
  if (cmname == 'SOFT SHEAR' .and. gamma > 0) ddsdde(4:6, 4:6) = 2 * ddsdde(4:6, 4:6)
  if (cmname == 'UNSYMMETRIC') ddsdde(1, 2:3) = 1.8d0 * ddsdde(1, 2:3)
  if (cmname == 'ELASTIC BEYOND 5 %' .and. statev(1) > 0.05d0) call make_elastic
  if (cmname == 'NO ENERGY') sse = 0
  if (cmname == 'NO ENERGY') spd = 0
  if (cmname == 'BEYOND STATEV') call write_to(statev, nstatv + 1)
  if (cmname == 'FAR BEYOND STATEV') call write_to(statev, nstatv + 500)
  if (cmname == 'BEYOND STRESS') call write_to(stress, 7)
  if (cmname == 'PROPS') props = 0
  if (statev(1) > 0.01d0 .and. time(2) > 0) call go_wrong
  if (cmname == 'CRASH AT ONCE') call crash

contains

  subroutine write_to(array, place)
    integer, intent(in) :: place
    double precision, intent(inout) :: array(*)
    array(place) = 7
  end subroutine

  subroutine make_elastic
    ddsdde = 0
    ddsdde(1:3, 1:3) = (bulk - 2 * shear / 3) / after
    do i = 1, 6
      ddsdde(i, i) = ddsdde(i, i) + merge(2, 1, i <= 3) * shear / after
    end do
  end subroutine

  double precision function determinant(a)
    double precision, intent(in) :: a(3, 3)
    determinant = a(1, 1) * (a(2, 2) * a(3, 3) - a(2, 3) * a(3, 2)) - a(1, 2) * (a(2, 1) * a(3, 3) - &
        a(2, 3) * a(3, 1)) + a(1, 3) * (a(2, 1) * a(3, 2) - a(2, 2) * a(3, 1))
  end function

  subroutine go_wrong
    double precision :: zero
    integer :: whole
    zero = statev(1) - statev(1)
    select case (cmname)
    case ('CRASH')
      call crash
    case ('ZERO')
      whole = int(zero)
      statev(1) = 7 / whole
    case ('STRESS')
      stress(2) = zero / zero
    case ('TANGENT')
      ddsdde(2, 3) = 1 / zero
    case ('CUT')
      if (dtime > 0.004d0) pnewdt = 0.5d0
    case ('XIT')
      call xit
    case ('STOP')
      stop
    case ('WARNS')
      call stdb_abqerr(-1, 'strain %R at point %I of %S', [npt], statev(1:1), ['TEST    '])
    case ('ENDS')
      call stdb_abqerr(-3, 'strain %R is too large', [npt], statev(1:1), ['TEST    '])
    end select
  end subroutine

  subroutine crash
    use iso_c_binding
    double precision, pointer :: nowhere(:)
    call c_f_pointer(transfer(8_c_intptr_t, c_null_ptr), nowhere, [10])
    nowhere(1) = statev(1)
  end subroutine

end subroutine
